// Quintics and their timing.
#include "core/robot/minimum_jerk.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::robot {

Quintic::Quintic(const ScalarMotion& from, double goal, double duration_s) : duration_s_(std::max(duration_s, 0.0)) {
  const double T = duration_s_;
  const double d = goal - from.position, v = from.velocity * T, a = from.acceleration * T * T;
  c_ = {from.position, v, a / 2, 10 * d - 6 * v - 1.5 * a, -15 * d + 8 * v + 1.5 * a, 6 * d - 3 * v - 0.5 * a};
  if (T <= 0) c_ = {goal, 0, 0, 0, 0, 0};
}

ScalarMotion Quintic::at(double t_s) const {
  if (duration_s_ <= 0 || t_s < 0) return {c_[0], 0, 0};
  const double T = duration_s_, s = t_s / T;
  if (s >= 1) return {c_[0] + c_[1] + c_[2] + c_[3] + c_[4] + c_[5], 0, 0};
  const auto& c = c_;
  return {c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5])))),
          (c[1] + s * (2 * c[2] + s * (3 * c[3] + s * (4 * c[4] + s * 5 * c[5])))) / T,
          (2 * c[2] + s * (6 * c[3] + s * (12 * c[4] + s * 20 * c[5]))) / (T * T)};
}

double quintic_duration_s(double distance, double rate_max, double acceleration_max) {
  const double d = std::abs(distance);
  return std::max(quintic_speed_factor * d / rate_max, std::sqrt(quintic_acceleration_factor * d / acceleration_max));
}

JointMotion::JointMotion(std::span<const double> positions) : size_(std::min(positions.size(), coordinates_max)) {
  for (std::size_t k = 0; k < size_; ++k) motions_[k] = Quintic({positions[k], 0, 0}, positions[k], 0);
}

void JointMotion::plan(std::span<const ScalarMotion> from, std::span<const double> goal, double duration_s) {
  duration_s_ = duration_s;
  for (std::size_t k = 0; k < size_; ++k) motions_[k] = Quintic(from[k], goal[k], duration_s);
}

double JointMotion::strain(double rate_max, double acceleration_max) const {
  constexpr int samples = 24;
  double worst = 0;
  for (std::size_t k = 0; k < size_; ++k) {
    for (int i = 1; i < samples; ++i) {
      const ScalarMotion m = motions_[k].at(duration_s_ * i / samples);
      worst = std::max({worst, std::abs(m.velocity) / rate_max, std::abs(m.acceleration) / acceleration_max});
    }
  }
  return worst;
}

void JointMotion::go(std::span<const ScalarMotion> from, std::span<const double> goal, double start_s,
                     double rate_max, double acceleration_max) {
  size_ = std::min({from.size(), goal.size(), coordinates_max});
  start_s_ = start_s;
  double duration_s = 0;
  for (std::size_t k = 0; k < size_; ++k) {
    const double coast = quintic_duration_s(goal[k] - from[k].position, rate_max, acceleration_max);
    const double brake = 1.5 * std::abs(from[k].velocity) / acceleration_max;
    duration_s = std::max({duration_s, coast, brake});
  }
  plan(from, goal, duration_s);
  if (strain(rate_max, acceleration_max) <= 1 + 1e-9) return;  // always so from rest
  // A start in motion may need longer, or keep no limit at all (it cannot stop accelerating at once): then
  // the duration that strains them least.
  double best_s = duration_s, best = strain(rate_max, acceleration_max);
  for (int i = 0; i < 24 && best > 1 + 1e-9; ++i) {
    duration_s *= 1.1;
    plan(from, goal, duration_s);
    const double now = strain(rate_max, acceleration_max);
    if (now < best) {
      best = now;
      best_s = duration_s;
    }
  }
  plan(from, goal, best_s);
}

void JointMotion::stop(std::span<const ScalarMotion> from, double start_s, double acceleration_max) {
  size_ = std::min(from.size(), coordinates_max);
  start_s_ = start_s;
  double duration_s = 0;
  for (std::size_t k = 0; k < size_; ++k) {
    duration_s = std::max(duration_s, 1.5 * std::abs(from[k].velocity) / acceleration_max);
  }
  // A rest at p + v T/2 + a T^2/12 is where speed falls to zero without turning back.
  duration_s_ = duration_s;
  for (std::size_t k = 0; k < size_; ++k) {
    const double rest =
        from[k].position + from[k].velocity * duration_s / 2 + from[k].acceleration * duration_s * duration_s / 12;
    motions_[k] = Quintic(from[k], rest, duration_s);
  }
}

void JointMotion::at(double t_s, std::span<ScalarMotion> out) const {
  for (std::size_t k = 0; k < std::min(size_, out.size()); ++k) out[k] = at(k, t_s);
}

}  // namespace eciton::robot
