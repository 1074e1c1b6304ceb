// What estimation publishes: the state, the wrenches, and for people what went wrong.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/robot/arrays.hpp"
#include "services/estimation/estimation_service.hpp"

namespace eciton::estimation {
namespace {

msg::EstimatorMode to_message(FilterMode mode) { return static_cast<msg::EstimatorMode>(mode); }

bool finite(const Estimate& e) {
  return e.X_WB.p.allFinite() && e.X_WB.R.allFinite() && e.v_WB.allFinite() && e.w_WB_B.allFinite() &&
         std::all_of(e.variance.begin(), e.variance.end(), [](double v) { return std::isfinite(v); });
}

bool finite(const robot::Wrench& w) { return w.force.allFinite() && w.moment.allFinite(); }

constexpr double never_heard_s = -1;  // as an age: see core/robot/freshness.hpp

constexpr const char* device_names[] = {"imu", "pose source", "joints", "rotor command", "peer wrench", "estimate"};
constexpr const char* phase_names[] = {"idle", "measuring", "done", "refused"};

}  // namespace

void EstimationService::describe(msg::Heartbeat& heartbeat) const noexcept {
  heartbeat.rejected = 0;
  for (const RefusalSpell& spell : spells_) heartbeat.rejected += spell.refused();
}

void EstimationService::publish_state(TimePoint now) noexcept {
  if (!finite(estimate_)) {
    // Better no state, which everybody notices, than one that is no number; the filter begins anew.
    spell(Device::output).refuse(Refusal::not_finite, to_ns(now));
    filter_.forget();
    observer_.reset();
    return;
  }
  msg::ModuleState out;
  out.module_id = config_.module_id;
  // Of the IMU sample it holds for: with the IMU silent it ages, and control notices. Before the first, of now.
  out.stamp_ns = estimate_.stamp_ns != 0 ? estimate_.stamp_ns : to_ns(now);
  out.mode = to_message(estimate_.mode);
  out.p_WM_m = robot::array(state_.p_WM);
  out.q_WM = robot::quaternion(estimate_.X_WB.R);
  out.v_WM_m_s = robot::array(state_.v_WM);
  out.w_WM_M_rad_s = robot::array(estimate_.w_WB_B);
  out.variance = estimate_.variance;
  out.pose_age_s = estimate_.pose_age_s;
  module_state_.write(out);
}

void EstimationService::publish_external_wrench(TimePoint now) noexcept {
  if (!finite(external_W_)) {
    spell(Device::output).refuse(Refusal::not_finite, to_ns(now));
    external_W_ = {};
    observer_.reset();
    return;
  }
  own_ = {};
  own_.module_id = config_.module_id;
  own_.stamp_ns = to_ns(now);
  own_.epoch = view_.active ? view_.active_epoch : 0;
  own_.zeroed = zeroing_.zeroed() || !config_.zeroing;
  own_.zero_quality_N = zeroing_.quality_N();
  own_.force_W_N = robot::array(external_W_.force);
  own_.moment_W_Nm = robot::array(external_W_.moment);
  own_.r_W_m = robot::array(state_.p_WM);
  for (std::size_t port = 0; port < std::min<std::size_t>(airframe_.ports.size(), 4); ++port) {
    const robot::Pose X_BP = robot::port_pose_B(airframe_, static_cast<int>(port), joint_angles());
    const auto p_WP = robot::array(estimate_.X_WB * X_BP.p);
    std::copy(p_WP.begin(), p_WP.end(), own_.port_W_m.begin() + static_cast<std::ptrdiff_t>(3 * port));
  }
  external_wrench_.write(own_);
}

void EstimationService::publish_contact_wrench(TimePoint now) noexcept {
  const std::size_t n = view_.active ? view_.members.size() : 0;
  if (n < 2) return;
  std::array<MemberWrench, robot::members_max> members;
  for (std::size_t k = 0; k < n; ++k) {
    const bool own = view_.members[k] == config_.module_id;
    const msg::ExternalWrench& w = own ? own_ : heard_[k];
    // A wrench of another epoch belongs to a body that is no more, or not yet: it counts as not heard.
    const bool known = own || (w.module_id == view_.members[k] && w.epoch == view_.active_epoch);
    members[k] = {.known = known,
                  .age_s = own     ? 0
                           : known ? to_s(now - heard_at_[k])
                                   : never_heard_s,
                  .external_W = {robot::vector(w.force_W_N), robot::vector(w.moment_W_Nm)},
                  .r_W = robot::vector(w.r_W_m),
                  .port_to_next_W = {w.port_W_m[0], w.port_W_m[1], w.port_W_m[2]},
                  .port_to_last_W = {w.port_W_m[3], w.port_W_m[4], w.port_W_m[5]}};
  }
  const ContactWrenches contacts = contact_wrenches(std::span<const MemberWrench>(members).first(n));
  msg::ContactWrench out;
  out.module_id = config_.module_id;
  out.stamp_ns = to_ns(now);
  out.epoch = view_.active_epoch;
  out.fresh = static_cast<std::uint32_t>(contacts.fresh);
  out.common_force_W_N = robot::array(contacts.common_W.force);
  out.common_moment_W_Nm = robot::array(contacts.common_W.moment);
  for (std::size_t k = 0; k < n; ++k) {
    const MemberContact& contact = contacts.members[k];
    if (!finite(contact.d_W) || !finite(contact.contact_W)) {
      spell(Device::output).refuse(Refusal::not_finite, to_ns(now));
      return;
    }
    out.members.push_back({.module_id = view_.members[k],
                           .age_s = members[k].age_s,
                           .r_W_m = robot::array(contact.r_W),
                           .d_force_W_N = robot::array(contact.d_W.force),
                           .d_moment_W_Nm = robot::array(contact.d_W.moment),
                           .link_W_m = robot::array(contact.link_W),
                           .link_force_W_N = robot::array(contact.contact_W.force),
                           .link_moment_W_Nm = robot::array(contact.contact_W.moment)});
  }
  contact_wrench_.write(out);
}

void EstimationService::report_mode(TimePoint now) noexcept {
  const msg::EstimatorMode mode = to_message(estimate_.mode);
  if (mode == reported_mode_) return;
  msg::Event out{
      .module_id = config_.module_id, .stamp_ns = to_ns(now), .service = "estimation", .machine = "filter"};
  out.from = bus::EnumTraits<msg::EstimatorMode>::names[static_cast<std::size_t>(reported_mode_)];
  out.to = bus::EnumTraits<msg::EstimatorMode>::names[static_cast<std::size_t>(mode)];
  event_.write(out);
  reported_mode_ = mode;
}

void EstimationService::answer_zero(std::uint64_t correlation_id, msg::GoalPhase phase, std::string_view reason,
                                    TimePoint now) noexcept {
  msg::GoalStatus out;
  out.module_id = config_.module_id;
  out.goal = msg::GoalKind::mode;
  out.stamp_ns = to_ns(now);
  out.correlation_id = correlation_id;
  out.phase = phase;
  out.reason = reason;
  goal_status_.write(out);
  if (phase == msg::GoalPhase::accepted) return;
  zero_answered_ = correlation_id;
  if (zero_goal_ == correlation_id) zero_goal_ = 0;
}

void EstimationService::publish_model_errors(TimePoint now) noexcept {
  const robot::ModelErrors& errors = zeroing_.errors();
  msg::ModelErrors out{.module_id = config_.module_id, .stamp_ns = to_ns(now)};
  for (std::size_t k = 0; k < airframe_.rotors.size(); ++k) {
    out.thrust_share.push_back(errors[static_cast<Eigen::Index>(k)]);
  }
  out.mass_share = errors[robot::error_mass];
  out.com_B_m = robot::array(errors.segment<3>(robot::error_com));
  out.attitude_rad = robot::array(errors.segment<3>(robot::error_attitude));
  model_errors_.write(out);
}

void EstimationService::report_zeroing(ZeroingPhase before, TimePoint now) noexcept {
  const ZeroingPhase phase = zeroing_.phase();
  msg::Event out{
      .module_id = config_.module_id, .stamp_ns = to_ns(now), .service = "estimation", .machine = "zeroing"};
  out.from = phase_names[static_cast<std::size_t>(before)];
  out.to = phase_names[static_cast<std::size_t>(phase)];
  char detail[decltype(out.detail)::bound() + 1] = "";
  if (phase == ZeroingPhase::done || phase == ZeroingPhase::refused) {
    std::snprintf(detail, sizeof detail, "%s%sto %d mN, %d mNm", zeroing_.reason(),
                  phase == ZeroingPhase::refused ? ": " : "", static_cast<int>(1e3 * zeroing_.quality_N()),
                  static_cast<int>(1e3 * zeroing_.quality_Nm()));
  }
  out.detail = static_cast<const char*>(detail);
  event_.write(out);
  if (phase == ZeroingPhase::done && config_.zeroing) publish_model_errors(now);
  if (zero_goal_ == 0) return;
  if (phase == ZeroingPhase::done) answer_zero(zero_goal_, msg::GoalPhase::succeeded, "", now);
  if (phase == ZeroingPhase::refused) answer_zero(zero_goal_, msg::GoalPhase::aborted, zeroing_.reason(), now);
}

void EstimationService::report_refusals(TimePoint now) noexcept {
  for (std::size_t k = 0; k < spells_.size(); ++k) {
    const auto report = spells_[k].report(to_ns(now));
    if (!report) continue;
    msg::Fault out{.module_id = config_.module_id, .stamp_ns = to_ns(now)};
    out.severity = report->over ? msg::Severity::info : msg::Severity::warning;
    out.service = "estimation";
    out.device = device_names[k];
    char words[decltype(out.text)::bound() + 1];
    const auto refused = static_cast<unsigned long long>(report->refused);
    const int lasted_ms = static_cast<int>(std::min(1e3 * report->lasted_s, 1e9));
    std::snprintf(words, sizeof words, "%s%s: %llu refused in %d ms", report->over ? "good again, was " : "",
                  text(report->cause), refused, lasted_ms);
    out.text = static_cast<const char*>(words);
    fault_.write(out);
  }
}

}  // namespace eciton::estimation
