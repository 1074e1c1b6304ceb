// What acts on a whole chain from outside, and each member's share of it. The members' external wrenches add up to
// the chain's total whatever passes through the links; how the total is spread over the members is not seen, so the
// likeliest spread is taken: independent forces on the members, and moments a lever's worth of them.
#pragma once

#include <cstddef>

#include "core/robot/frames.hpp"

namespace eciton::robot {

/// Standard deviation of the moments that act on a member by those of the forces, m: 0.2 m is where LEGION's rotors
/// stand, whose thrust errors and wakes make both. Infinite: moments only, all alike, as in (9) of LEGION.
inline constexpr double disturbance_lever_m = 0.2;

/// One member's external wrench about its r, and how much it counts (0 to 1).
struct ChainLoad {
  Wrench external_W;
  Vector3 r_W = Vector3::Zero();
  double weight = 1;
};

class ChainDisturbance {
 public:
  ChainDisturbance() = default;
  /// Of `count` loads, `load(k)` each; nothing when all weights are zero. World axes. Real-time safe.
  template <class Load>
  ChainDisturbance(std::size_t count, const Load& load, double lever_m = disturbance_lever_m) : lever_m_(lever_m) {
    double weight = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const ChainLoad one = load(k);
      if (one.weight <= 0) continue;  // nothing of it is looked at
      weight += one.weight;
      mean_r_W_ += one.weight * one.r_W;
      force_W_ += one.weight * one.external_W.force;
    }
    if (weight < 1e-9) {
      *this = {};
      return;
    }
    mean_r_W_ /= weight;
    force_W_ /= weight;
    // Forces F = t x rho and moments M = l^2 t are the least sum of |F|^2 + |M|^2 / l^2 that makes the total moment:
    // sum w (|rho|^2 - rho rho^T) t + l^2 sum w t = total.
    Matrix3 inertia = lever_m * lever_m * weight * Matrix3::Identity();
    Vector3 total = Vector3::Zero();
    for (std::size_t k = 0; k < count; ++k) {
      const ChainLoad one = load(k);
      if (one.weight <= 0) continue;
      const Vector3 rho = one.r_W - mean_r_W_;
      inertia += one.weight * (rho.squaredNorm() * Matrix3::Identity() - rho * rho.transpose());
      total += one.weight * (one.external_W.moment + rho.cross(one.external_W.force));
    }
    moment_W_ = total / weight;
    turn_W_ = inertia.inverse() * total;
  }

  /// The share of a member about its r: a mean force, a force that grows with the lever, and a moment. The weighed
  /// shares add up to the weighed loads, force and moment.
  Wrench share(const Vector3& r_W) const {
    return {force_W_ + turn_W_.cross(r_W - mean_r_W_), lever_m_ * lever_m_ * turn_W_};
  }
  const Vector3& force_W() const { return force_W_; }
  const Vector3& mean_r_W() const { return mean_r_W_; }
  /// Total moment about the mean of the r by the sum of the weights.
  const Vector3& moment_W() const { return moment_W_; }

 private:
  double lever_m_ = disturbance_lever_m;
  Vector3 force_W_ = Vector3::Zero(), moment_W_ = Vector3::Zero(), mean_r_W_ = Vector3::Zero();
  Vector3 turn_W_ = Vector3::Zero();  // N/m
};

}  // namespace eciton::robot
