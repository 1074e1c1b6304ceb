// First-order, rate-limited lags of the rotors.
#include "core/robot/actuator_lag.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::robot {
namespace {

double share(double dt_s, double time_constant_s) {
  return time_constant_s > 0 ? 1 - std::exp(-dt_s / time_constant_s) : 1.0;
}

}  // namespace

ActuatorLag::ActuatorLag(const Airframe& airframe, const ActuatorLagConfig& config)
    : config_(config), airframe_(airframe) {
  if (airframe_.rotors.size() > rotors_max) airframe_.rotors.resize(rotors_max);
  for (RotorOutput& rotor : rotors_) rotor.thrust_N = airframe_.hover_thrust_N();
}

void ActuatorLag::set(std::span<const RotorOutput> rotors) {
  std::copy_n(rotors.begin(), std::min(rotors.size(), airframe_.rotors.size()), rotors_.begin());
}

void ActuatorLag::update(std::span<const RotorOutput> commands, double dt_s) {
  const double thrust_share = share(dt_s, config_.thrust_time_constant_s);
  const double gimbal_share = share(dt_s, config_.gimbal_time_constant_s);
  for (std::size_t k = 0; k < std::min(commands.size(), airframe_.rotors.size()); ++k) {
    RotorOutput& rotor = rotors_[k];
    rotor.thrust_N += thrust_share * (commands[k].thrust_N - rotor.thrust_N);
    const double step_rad_max = airframe_.rotors[k].gimbal_rate_rad_s_max * dt_s;
    for (std::size_t g = 0; g < 2; ++g) {
      const double step = gimbal_share * (commands[k].gimbal_rad[g] - rotor.gimbal_rad[g]);
      rotor.gimbal_rad[g] += std::clamp(step, -step_rad_max, step_rad_max);
    }
  }
}

}  // namespace eciton::robot
