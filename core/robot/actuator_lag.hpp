// What the rotors really do some time after being told: first-order lags of thrust and gimbals, the
// gimbals rate-limited. The wrench observer's known wrench comes from here, not from the command.
#pragma once

#include <array>
#include <span>

#include "core/robot/allocation.hpp"

namespace eciton::robot {

struct ActuatorLagConfig {
  double thrust_time_constant_s = 0.030;  // of the modelled rotors; 0: at once
  double gimbal_time_constant_s = 0.040;
};

/// Real-time safe after construction; one thread.
class ActuatorLag {
 public:
  explicit ActuatorLag(const Airframe& airframe, const ActuatorLagConfig& config = {});

  /// Says where the rotors are (measured, or after a restart); until then they are taken to hover.
  void set(std::span<const RotorOutput> rotors);
  /// Moves on by dt under commands held constant; exact for the lag, at any dt.
  void update(std::span<const RotorOutput> commands, double dt_s);
  std::span<const RotorOutput> rotors() const { return {rotors_.data(), airframe_.rotors.size()}; }
  Wrench wrench_B(const Vector3& com_offset_B) const { return rotor_wrench_B(airframe_, rotors(), com_offset_B); }

 private:
  ActuatorLagConfig config_;
  Airframe airframe_;
  std::array<RotorOutput, rotors_max> rotors_{};
};

}  // namespace eciton::robot
