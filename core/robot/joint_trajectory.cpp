// Joint goals: limits and timing around the quintics.
#include "core/robot/joint_trajectory.hpp"

#include <algorithm>
#include <array>

namespace eciton::robot {

JointTrajectory::JointTrajectory(const Airframe& airframe, const JointTrajectoryConfig& config)
    : airframe_(airframe), config_(config) {
  const std::array<double, joints_max> zero{};
  reset(std::span(zero).first(std::min(airframe_.joints.size(), zero.size())), 0);
}

void JointTrajectory::reset(std::span<const double> position_rad, std::size_t base) {
  present_ = JointMotion(position_rad);
  has_next_ = false;
  base_ = base;
}

std::optional<LimitFault> JointTrajectory::go(std::span<const double> goal_rad, double rate_rad_s, double now_s,
                                              double start_s) {
  if (goal_rad.size() != size()) {
    return LimitFault{LimitKind::count, 0, 0, static_cast<double>(goal_rad.size()), static_cast<double>(size())};
  }
  const double rate = rate_rad_s == 0 ? config_.rate_rad_s : rate_rad_s;
  if (const auto fault = check_rate(airframe_, rate)) return fault;
  if (const auto fault = check_positions(airframe_, goal_rad)) return fault;
  const double begin_s = std::max(now_s, start_s);
  std::array<ScalarMotion, coordinates_max> from;
  std::array<double, coordinates_max> from_rad;
  at(begin_s, from);
  for (std::size_t k = 0; k < size(); ++k) from_rad[k] = from[k].position;
  const std::span<const double> there = std::span(from_rad).first(size());
  if (const auto fault = check_chain_tilt(airframe_, base_, there, goal_rad, config_.tilt_rad_max)) return fault;
  if (const auto fault = check_chain_collision(airframe_, there, goal_rad)) return fault;

  if (has_next_ && now_s >= next_.start_s()) present_ = next_;
  next_.go(std::span(from).first(size()), goal_rad, begin_s, rate, config_.acceleration_rad_s2_max);
  has_next_ = true;
  return std::nullopt;
}

void JointTrajectory::stop(double now_s) {
  std::array<ScalarMotion, coordinates_max> from;
  at(now_s, from);
  JointMotion stopping;
  stopping.stop(std::span(from).first(size()), now_s, config_.acceleration_rad_s2_max);
  present_ = stopping;
  has_next_ = false;
}

ScalarMotion JointTrajectory::at(std::size_t joint, double t_s) const {
  return has_next_ && t_s >= next_.start_s() ? next_.at(joint, t_s) : present_.at(joint, t_s);
}

void JointTrajectory::at(double t_s, std::span<ScalarMotion> out) const {
  for (std::size_t k = 0; k < std::min(size(), out.size()); ++k) out[k] = at(k, t_s);
}

double JointTrajectory::end_s() const {
  const JointMotion& last = has_next_ ? next_ : present_;
  return last.start_s() + last.duration_s();
}

bool JointTrajectory::finished(double t_s) const { return t_s >= end_s(); }

}  // namespace eciton::robot
