// Lags and limits of rotors, gimbals and joint servos.
#include "hal/sim/actuators.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::hal::sim {
namespace {

constexpr double servo_stiffness_Nm_rad = 120;

double finite_or(double value, double otherwise) { return std::isfinite(value) ? value : otherwise; }

}  // namespace

void RotorActuator::step(const RotorSetpoint& command, bool armed, double dt_s) {
  const double wanted_N = armed ? std::clamp(finite_or(command.thrust_N, 0), 0.0, rotor_->thrust_N_max) : 0.0;
  thrust_N_ += (1 - std::exp(-dt_s / thrust_lag_s)) * (wanted_N - thrust_N_);
  const double share = 1 - std::exp(-dt_s / gimbal_lag_s);
  const double move_rad_max = rotor_->gimbal_rate_rad_s_max * dt_s;
  for (std::size_t k = 0; k < gimbal_rad_.size(); ++k) {
    const double wanted_rad =
        std::clamp(finite_or(command.gimbal_rad[k], gimbal_rad_[k]), -rotor_->gimbal_rad_max, rotor_->gimbal_rad_max);
    gimbal_rad_[k] += std::clamp(share * (wanted_rad - gimbal_rad_[k]), -move_rad_max, move_rad_max);
  }
  const auto [phi, theta] = gimbal_rad_;
  direction_B_ = {std::sin(theta), -std::sin(phi) * std::cos(theta), std::cos(phi) * std::cos(theta)};
}

double JointActuator::step(const JointSetpoint& command, bool powered, double position_rad, double dt_s) {
  const double measured_rad = encoder_rad(position_rad);
  if (!powered) {
    was_powered_ = false;
    return torque_Nm_ = 0;
  }
  if (!was_powered_) reference_rad_ = measured_rad;  // a servo switched on starts from where it is
  was_powered_ = true;
  const double wanted_rad = std::clamp(finite_or(command.position_rad, reference_rad_), -joint_->position_rad_max,
                                       joint_->position_rad_max);
  const double move_rad_max = joint_->rate_rad_s_max * dt_s;
  reference_rad_ += std::clamp(wanted_rad - reference_rad_, -move_rad_max, move_rad_max);
  torque_Nm_ = std::clamp(servo_stiffness_Nm_rad * (reference_rad_ - measured_rad), -joint_->torque_Nm_max,
                          joint_->torque_Nm_max);
  return torque_Nm_;
}

}  // namespace eciton::hal::sim
