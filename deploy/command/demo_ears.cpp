// Truth beside estimate, sample by sample.
#include "deploy/command/demo_ears.hpp"

#include <cmath>
#include <cstdlib>

#include "core/base/wall_clock.hpp"

namespace eciton::deploy {
namespace {

double length(const std::array<double, 3>& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/// Stamps further apart are not compared; nearer ones are brought together by the velocity.
constexpr std::int64_t comparable_ns = 20'000'000;

}  // namespace

DemoEar::DemoEar(std::uint32_t id, const bus::ParticipantConfig& config)
    : id_(id),
      ring_(config),
      heartbeat_(ring_.create_reader(topics::heartbeat)),
      external_wrench_(ring_.create_reader(topics::external_wrench)),
      contact_wrench_(ring_.create_reader(topics::contact_wrench)),
      truth_pose_(ring_.create_reader(topics::truth_pose)),
      truth_contact_(ring_.create_reader(topics::truth_contact)) {}

void DemoEar::poll(DemoPhase phase, const msg::ModuleState* state, DemoFigures& figures) {
  while (const auto beat = heartbeat_.take()) {
    const std::string service(beat->value.service.view());
    heartbeats_[service] = beat->value;
    beat_heard_at_[service] = monotonic_now();
  }
  while (const auto wrench = external_wrench_.take()) {
    if (wrench->value.module_id == id_) zeroed_ = wrench->value.zeroed;
  }
  while (const auto wrench = contact_wrench_.take()) {
    // Each module's own link, so that no link is counted twice.
    for (const msg::MemberWrench& member : wrench->value.members) {
      if (member.module_id == id_ && latched_)
        figures.contact_force_N_estimated[phase].add(length(member.link_force_W_N));
    }
  }
  while (const auto contact = truth_contact_.take()) {
    if (contact->value.module_id != id_) continue;
    latched_ = contact->value.latched;
    if (!latched_) continue;
    figures.contact_force_N[phase].add(length(contact->value.force_W_N));
    figures.contact_moment_Nm[phase].add(length(contact->value.moment_W_Nm));
  }
  while (const auto pose = truth_pose_.take()) {
    truth_ = pose->value;
    if (phase != DemoPhase::hovering || !goal_m_) continue;
    const auto& p = truth_->p_WM_m;
    figures.tracking_error_m.add(length({p[0] - (*goal_m_)[0], p[1] - (*goal_m_)[1], p[2] - (*goal_m_)[2]}));
  }
  if (phase == DemoPhase::grounded || state == nullptr || !truth_ || state->stamp_ns == compared_ns_) return;
  const std::int64_t later_ns = state->stamp_ns - truth_->stamp_ns;
  if (std::abs(later_ns) > comparable_ns) return;
  compared_ns_ = state->stamp_ns;
  std::array<double, 3> error_m{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double truth_m = truth_->p_WM_m[k] + 1e-9 * static_cast<double>(later_ns) * truth_->v_WM_m_s[k];
    error_m[k] = state->p_WM_m[k] - truth_m;
  }
  figures.estimation_error_m.add(length(error_m));
}

Duration DemoEar::heartbeat_age(const std::string& service) const {
  const auto heard = beat_heard_at_.find(service);
  return heard == beat_heard_at_.end() ? Duration::max() : monotonic_now() - heard->second;
}

std::optional<msg::FlightMode> DemoEar::flight_mode() const {
  const auto control = heartbeats_.find("control");
  if (control == heartbeats_.end()) return std::nullopt;
  return control->second.flight_mode;
}

}  // namespace eciton::deploy
