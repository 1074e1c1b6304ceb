// Levelling and descending without a position.
#include "core/robot/safe_descent.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::robot {

SafeDescent::SafeDescent(const SafeDescentConfig& config, double mass_kg, const Matrix3& I_kg_m2)
    : config_(config), mass_kg_(mass_kg), I_kg_m2_(I_kg_m2) {}

void SafeDescent::start(SafeManoeuvre manoeuvre, const Matrix3& R_WB, double vertical_speed_m_s,
                        const Wrench& feed_forward_W) {
  manoeuvre_ = manoeuvre;
  phase_ = manoeuvre == SafeManoeuvre::descend ? SafePhase::descending : SafePhase::holding;
  R_WB_hold_ = R_WB;
  feed_forward_W_ = feed_forward_W;
  vertical_speed_m_s_ = vertical_speed_m_s;
  elapsed_s_ = descending_s_ = at_least_s_ = 0;
  force_share_ = 1;
}

Vector3 SafeDescent::attitude_error(const Matrix3& R_WB) const {
  Vector3 error;
  if (manoeuvre_ == SafeManoeuvre::hold_hover || phase_ == SafePhase::holding) {
    error = log_so3(R_WB.transpose() * R_WB_hold_);
  } else {
    // Least turn that brings body z upright; yaw is free, it is not known well.
    const Vector3 up_B = R_WB.transpose().col(2);
    const Vector3 axis = Vector3::UnitZ().cross(up_B);
    const double sine = axis.norm();
    const double angle = std::atan2(sine, up_B.z());
    error = sine > 1e-9 ? Vector3(axis * (angle / sine)) : Vector3(up_B.z() < 0 ? 3.14 : 0.0, 0, 0);
  }
  const double size = error.norm();
  return size > config_.attitude_error_rad_max ? Vector3(error * (config_.attitude_error_rad_max / size)) : error;
}

Wrench SafeDescent::update(const Matrix3& R_WB, const Vector3& w_WB_B_rad_s, const Vector3& specific_force_B_m_s2,
                           double dt_s) {
  if (phase_ == SafePhase::idle || phase_ == SafePhase::landed) return {};
  elapsed_s_ += dt_s;
  if (phase_ == SafePhase::holding && elapsed_s_ >= config_.hold_s) phase_ = SafePhase::descending;
  const bool descending = phase_ == SafePhase::descending;
  if (descending) descending_s_ += dt_s;

  const double rise_m_s2 = (R_WB * specific_force_B_m_s2).z() - gravity_m_s2;
  vertical_speed_m_s_ += rise_m_s2 * dt_s;
  // A jolt that the thrust does not explain is the ground: whatever the integral has drifted to, the fall is over.
  if (descending && rise_m_s2 - (force_share_ - 1) * gravity_m_s2 > config_.ground_jolt_m_s2) vertical_speed_m_s_ = 0;
  vertical_speed_m_s_ = std::clamp(vertical_speed_m_s_, -3.0, 3.0);
  // The wanted speed comes in over a second, so that the thrust does not step.
  const double wanted = descending ? -config_.descent_m_s * std::min(1.0, descending_s_) : 0.0;
  const double share = 1 + config_.vertical_gain_1_s * (wanted - vertical_speed_m_s_) / gravity_m_s2;
  const double limited = std::clamp(share, config_.force_share_min, config_.force_share_max);
  force_share_ = limited;
  // Standing on the ground, the integrated speed no longer follows the wanted one.
  const bool pressing = descending && descending_s_ > 1 && vertical_speed_m_s_ > wanted + 0.6 * config_.descent_m_s;
  at_least_s_ = pressing ? at_least_s_ + dt_s : 0;
  if (at_least_s_ > config_.landed_s || descending_s_ > config_.descent_s_max) {
    phase_ = SafePhase::landed;
    return {};
  }

  const double fade = std::exp(-elapsed_s_ / config_.feed_forward_time_constant_s);
  const Vector3 force_W = Vector3::UnitZ() * (limited * mass_kg_ * gravity_m_s2) + fade * feed_forward_W_.force;
  const Vector3 alpha = config_.attitude_gain_1_s2 * attitude_error(R_WB) - config_.rate_gain_1_s * w_WB_B_rad_s;
  const Vector3 gyroscopic = w_WB_B_rad_s.cross(I_kg_m2_ * w_WB_B_rad_s);
  return {R_WB.transpose() * force_W,
          I_kg_m2_ * alpha + gyroscopic + fade * (R_WB.transpose() * feed_forward_W_.moment)};
}

}  // namespace eciton::robot
