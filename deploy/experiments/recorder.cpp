// Looks, filters, sums up.
#include "deploy/experiments/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/robot/arrays.hpp"

namespace eciton::deploy {
namespace {

constexpr double tick_s = 0.002;
constexpr double corner_Hz = 5;
constexpr std::uint64_t ticks_per_sample = 5;

/// Share of the difference that a first-order low-pass takes over in one tick.
double share() {
  static const double value = 1 - std::exp(-2 * std::numbers::pi * corner_Hz * tick_s);
  return value;
}

std::string numbered(const char* name, std::size_t number) { return name + std::to_string(number); }

}  // namespace

void Recorder::Sum::add(double value) {
  sum += value;
  max = std::max(max, value);
  ++count;
}

Recorder::Recorder(Simulation& simulation) : simulation_(simulation), links_(simulation.size()) {
  for (std::size_t k = 0; k < links_.size(); ++k) links_[k].module = k;
  simulation.executor().observe([this](TimePoint now) { look(now); });
}

void Recorder::follow(std::uint32_t module, Reference reference) {
  followed_ = module;
  reference_ = std::move(reference);
  for (std::size_t k = 0; k < simulation_.size(); ++k) {
    if (simulation_.id(k) == module) {
      estimates_.emplace(simulation_.listener(k).create_reader(topics::contact_wrench));
    }
  }
}

void Recorder::follow(std::uint32_t module, const robot::Pose& X_WM) {
  robot::PoseReference reference;
  reference.p_WM = X_WM.p;
  reference.R_WM = X_WM.R;
  follow(module, [reference](double) { return reference; });
}

void Recorder::start() {
  force_ = torque_ = force_estimated_ = torque_estimated_ = joint_torque_ = joint_speed_ = {};
  position_ = attitude_ = speed_ = {};
  for (Link& link : links_) {
    link.sum = {};
    link.count = 0;
  }
  recording_ = true;
}

void Recorder::look(TimePoint) {
  look_at_links();
  if (estimates_) {
    if (const auto newest = estimates_->take_newest()) estimate_ = newest->value;
  }
  ++ticks_;
  if (!recording_) return;
  const bool sampled = ticks_ % ticks_per_sample == 0;
  const double elapsed_s = simulation_.elapsed_s();
  if (sampled) note("time_s", elapsed_s);
  look_at_followed(elapsed_s, sampled);
  if (!estimate_ || !sampled) return;
  for (std::size_t k = 0; k + 1 < estimate_->members.size(); ++k) {
    const msg::MemberWrench& member = estimate_->members[k];
    const double force_N = robot::vector(member.link_force_W_N).norm();
    const double torque_Nm = robot::vector(member.link_moment_W_Nm).norm();
    force_estimated_.add(force_N);
    torque_estimated_.add(torque_Nm);
    note("contact_force_N_" + std::to_string(k + 1) + "_estimated", force_N);
    note("contact_torque_Nm_" + std::to_string(k + 1) + "_estimated", torque_Nm);
  }
}

void Recorder::look_at_links() {
  const robot::Airframe& airframe = simulation_.world().airframe();
  const bool sampled = recording_ && (ticks_ + 1) % ticks_per_sample == 0;
  for (Link& link : links_) {
    const auto truth = simulation_.world().truth_contact(simulation_.id(link.module), 0);
    if (!truth) {
      link.held = false;
      continue;
    }
    if (!link.held) link = {.module = link.module, .held = true, .sum = {}, .wrench = {}};
    link.wrench += (truth->wrench_P_W - link.wrench) * share();
    const std::array<std::pair<std::uint32_t, std::uint32_t>, 2> ends{
        {{truth->module_id, truth->port}, {truth->peer_id, truth->peer_port}}};
    for (std::size_t end = 0; end < ends.size(); ++end) {
      const auto joint = static_cast<std::size_t>(airframe.ports[ends[end].second].joint);
      const hal::JointReading reading = simulation_.world().truth_joint(ends[end].first, joint);
      link.joint_rad_s[end] += share() * (reading.velocity_rad_s - link.joint_rad_s[end]);
      if (!recording_) continue;
      joint_torque_.add(std::abs(reading.torque_Nm));
      joint_speed_.add(std::abs(link.joint_rad_s[end]));
    }
    if (!recording_) continue;
    link.sum += link.wrench;
    ++link.count;
    force_.add(link.wrench.force.norm());
    torque_.add(link.wrench.moment.norm());
  }
  if (sampled) note_links();
}

void Recorder::note_links() {
  // In the order of the chain: the member whose male port is free comes last.
  const robot::Airframe& airframe = simulation_.world().airframe();
  std::size_t number = 0;
  for (const std::size_t module : chain_order()) {
    const Link& link = links_[module];
    if (!link.held) continue;
    const auto truth = simulation_.world().truth_contact(simulation_.id(module), 0);
    ++number;
    note(numbered("contact_force_N_", number), link.wrench.force.norm());
    note(numbered("contact_torque_Nm_", number), link.wrench.moment.norm());
    const std::array<std::pair<std::uint32_t, std::uint32_t>, 2> ends{
        {{truth->module_id, truth->port}, {truth->peer_id, truth->peer_port}}};
    for (std::size_t end = 0; end < ends.size(); ++end) {
      const auto joint = static_cast<std::size_t>(airframe.ports[ends[end].second].joint);
      const hal::JointReading reading = simulation_.world().truth_joint(ends[end].first, joint);
      note(numbered("joint_rad_", 2 * number - 1 + end), reading.position_rad);
      note(numbered("joint_torque_Nm_", 2 * number - 1 + end), reading.torque_Nm);
    }
  }
}

std::vector<std::size_t> Recorder::chain_order() const {
  std::vector<std::size_t> order;
  std::vector<bool> is_peer(links_.size(), false);
  std::vector<std::size_t> next(links_.size(), links_.size());
  for (const Link& link : links_) {
    const auto truth = simulation_.world().truth_contact(simulation_.id(link.module), 0);
    if (!truth) continue;
    for (std::size_t k = 0; k < links_.size(); ++k) {
      if (simulation_.id(k) != truth->peer_id) continue;
      next[link.module] = k;
      is_peer[k] = true;
    }
  }
  for (std::size_t k = 0; k < links_.size(); ++k) {
    if (is_peer[k]) continue;
    for (std::size_t at = k; at < links_.size() && order.size() < links_.size(); at = next[at]) order.push_back(at);
  }
  return order;
}

void Recorder::look_at_followed(double elapsed_s, bool sampled) {
  if (!reference_) return;
  const hal::sim::TruthPose truth = simulation_.world().truth_pose(followed_);
  const robot::PoseReference reference = reference_(elapsed_s);
  const double error_m = (truth.p_WM_m - reference.p_WM).norm();
  const double error_rad = robot::log_so3(truth.X_WB.R.transpose() * reference.R_WM).norm();
  position_.add(error_m);
  attitude_.add(error_rad);
  speed_.add(truth.v_WM_m_s.norm());
  if (!sampled) return;
  note("position_error_m", error_m);
  note("attitude_error_rad", error_rad);
  note("speed_m_s", truth.v_WM_m_s.norm());
  const char* const axes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    note(std::string(axes[k]) + "_m", truth.p_WM_m[k]);
    note(std::string(axes[k]) + "_reference_m", reference.p_WM[k]);
  }
}

FlightFigures Recorder::figures() const {
  return {.contact_force_N_mean = force_.mean(),
          .contact_force_N_max = force_.max,
          .contact_torque_Nm_mean = torque_.mean(),
          .contact_torque_Nm_max = torque_.max,
          .contact_force_N_mean_estimated = force_estimated_.mean(),
          .contact_torque_Nm_mean_estimated = torque_estimated_.mean(),
          .joint_torque_Nm_mean = joint_torque_.mean(),
          .joint_torque_Nm_max = joint_torque_.max,
          .joint_speed_rad_s_max = joint_speed_.max,
          .position_error_m_mean = position_.mean(),
          .position_error_m_max = position_.max,
          .attitude_error_rad_mean = attitude_.mean(),
          .attitude_error_rad_max = attitude_.max,
          .speed_m_s_max = speed_.max};
}

std::vector<robot::Wrench> Recorder::mean_wrenches() const {
  std::vector<robot::Wrench> means;
  for (const Link& link : links_) {
    if (link.held && link.count > 0) means.push_back(link.sum * (1 / static_cast<double>(link.count)));
  }
  return means;
}

double Recorder::contact_force_N() const {
  double most = 0;
  for (const Link& link : links_) most = std::max(most, link.held ? link.wrench.force.norm() : 0.0);
  return most;
}

double Recorder::contact_torque_Nm() const {
  double most = 0;
  for (const Link& link : links_) most = std::max(most, link.held ? link.wrench.moment.norm() : 0.0);
  return most;
}

}  // namespace eciton::deploy
