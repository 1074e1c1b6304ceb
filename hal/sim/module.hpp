// One simulated module's state beside the physics: actuators, sensors, noise, what it was last told.
#pragma once

#include <vector>

#include "core/robot/thrust_map.hpp"
#include "hal/sim/actuators.hpp"
#include "hal/sim/battery.hpp"
#include "hal/sim/couplings.hpp"
#include "hal/sim/disturbances.hpp"
#include "hal/sim/mismatch.hpp"
#include "hal/sim/model.hpp"
#include "hal/sim/sensors.hpp"

namespace eciton::hal::sim {

/// Forces on a module's main body, summed about B's origin, world axes.
struct BodyLoad {
  robot::Wrench rotors;
  robot::Wrench air;  // gusts, wind, wakes, jets
};

class SimModule {
 public:
  SimModule(const WorldConfig& config, const robot::Airframe& airframe, const ModuleStart& start,
            const ModuleIndex& index, const Mismatch& mismatch);

  std::uint32_t id() const { return index_.id; }
  const ModuleIndex& index() const { return index_; }
  const Mismatch& mismatch() const { return mismatch_; }
  ActuatorFrame& command() { return command_; }

  /// Truth from the physics: pose of B at the present (qpos), twist (qvel).
  robot::Pose X_WB(const mjData* d) const;
  robot::Vector3 v_WB(const mjData* d) const { return Eigen::Map<const robot::Vector3>(d->qvel + index_.dof); }
  robot::Vector3 w_WB_B(const mjData* d) const { return Eigen::Map<const robot::Vector3>(d->qvel + index_.dof + 3); }
  void joint_angles(const mjData* d, std::span<double> joint_rad) const;

  /// Rotors and joint servos move on by a step; joint torques go to qfrc_applied.
  void step_actuators(mjData* d);
  robot::Wrench rotor_wrench_B_W(const robot::Matrix3& R_WB) const;
  double thrust_N() const;  // of all rotors, nominal
  const std::vector<RotorActuator>& rotors() const { return rotors_; }
  const JointActuator& joint(std::size_t k) const { return joints_[k]; }

  /// Puts the sum of all loads on the main body.
  void apply(const robot::Wrench& about_B_W, const robot::Matrix3& R_WB, mjData* d) const;

  /// Sensors, after the step that took v_WB from `v_before`; `R_before` its attitude then.
  void step_sensors(TimePoint now, const mjData* d, const robot::Vector3& v_before, const robot::Matrix3& R_before);
  /// The first samples, from the accelerations of the state the world begins with.
  void start_sensors(TimePoint now, const mjData* d);
  void fill(SensorFrame& frame) const;
  void break_sensor(SimSensor sensor, const SensorFault& fault, TimePoint now);

  UnitGust gust;
  UnitGust wake;
  robot::Wrench air;       // forces of the air, held between two updates
  robot::Wrench external;  // as set from outside

 private:
  void step_rotors();
  void sample_readings(const mjData* d);

  const robot::Airframe* airframe_;
  ModuleIndex index_;
  Mismatch mismatch_;
  ActuatorFrame command_;
  robot::ThrustMap thrust_map_;
  Battery battery_;
  double battery_noise_V_;
  Random battery_random_;
  std::vector<RotorActuator> rotors_;
  std::vector<JointActuator> joints_;
  ReadingConfig reading_config_;
  double noise_;
  Random reading_random_;
  ImuSensor imu_;
  PoseSensor pose_;
  std::array<RotorReading, max_rotors> rotor_readings_{};
  std::array<JointReading, max_joints> joint_readings_{};
  int steps_ = 0;
};

}  // namespace eciton::hal::sim
