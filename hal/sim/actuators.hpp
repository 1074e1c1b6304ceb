// What a module's motors and servos make of their commands: first-order lags, rate limits, saturation.
// Pure: commands in, thrust vectors and joint torques out, one call per step.
#pragma once

#include <array>
#include <span>

#include "core/robot/airframe.hpp"
#include "hal/sim/frames.hpp"

namespace eciton::hal::sim {

inline constexpr double thrust_lag_s = 0.030;
inline constexpr double gimbal_lag_s = 0.040;

/// A rotor on its gimbals. Thrust is the nominal model's; the world scales it by the mismatch.
class RotorActuator {
 public:
  explicit RotorActuator(const robot::RotorGeometry& rotor, double thrust_N = 0)
      : rotor_(&rotor), thrust_N_(thrust_N) {}

  /// Moves on by `dt_s`. Thrust is held to [0, max]; a command that is no number counts as none.
  void step(const RotorSetpoint& command, bool armed, double dt_s);

  double thrust_N() const { return thrust_N_; }
  const std::array<double, 2>& gimbal_rad() const { return gimbal_rad_; }
  /// Unit vector along the thrust, body axes: Rx(phi) Ry(theta) e_z.
  const robot::Vector3& direction_B() const { return direction_B_; }

 private:
  const robot::RotorGeometry* rotor_;
  double thrust_N_;
  std::array<double, 2> gimbal_rad_{};
  robot::Vector3 direction_B_ = robot::Vector3::UnitZ();
};

/// A dock joint's position servo: kp 120 Nm/rad on its own encoder, which may be off, reference
/// rate-limited. Damping and armature are the physics model's.
class JointActuator {
 public:
  JointActuator(const robot::JointGeometry& joint, double encoder_offset_rad)
      : joint_(&joint), offset_rad_(encoder_offset_rad) {}

  /// Torque on the joint, Nm. `position_rad` is the true angle.
  double step(const JointSetpoint& command, bool powered, double position_rad, double dt_s);

  double encoder_rad(double position_rad) const { return position_rad + offset_rad_; }
  double torque_Nm() const { return torque_Nm_; }

 private:
  const robot::JointGeometry* joint_;
  double offset_rad_;
  double reference_rad_ = 0;
  double torque_Nm_ = 0;
  bool was_powered_ = false;
};

}  // namespace eciton::hal::sim
