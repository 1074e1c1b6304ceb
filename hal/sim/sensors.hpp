// What a module's IMU and pose sensor report of the truth: sampling, noise, bias, drift, latency.
// Fed once per physics step; no clock, no physics engine.
#pragma once

#include <array>
#include <cstdint>

#include "core/robot/frames.hpp"
#include "hal/interfaces.hpp"
#include "hal/sim/random.hpp"
#include "hal/sim/sensor_fault.hpp"
#include "hal/sim/world_config.hpp"

namespace eciton::hal::sim {

/// An IMU at B's origin. Acceleration is the mean over the sample's period (it integrates between samples,
/// as the chips do), angular velocity that at the stamp.
class ImuSensor {
 public:
  ImuSensor(const ImuConfig& config, double noise_scale, Random random, Random fault);

  /// After each physics step: the mean specific force over it, and the angular velocity at its end, body axes.
  void step(TimePoint now, const robot::Vector3& f_B_m_s2, const robot::Vector3& w_WB_B_rad_s);
  const ImuReading& reading() const { return reading_; }
  /// How many have come: a reader knows by it whether there is a new one, whatever its stamp says.
  std::uint64_t count() const { return count_; }
  void set_fault(const SensorFault& fault, TimePoint now) { fault_.set(fault, now); }

 private:
  void sample(TimePoint now, const robot::Vector3& f_B_m_s2, const robot::Vector3& w_WB_B_rad_s);

  ImuConfig config_;
  double scale_;
  Random random_;
  robot::Vector3 accelerometer_bias_, gyroscope_bias_;
  int period_steps_;
  int steps_ = 0;  // since the last sample; the first call samples at once
  bool started_ = false;
  robot::Vector3 sum_ = robot::Vector3::Zero();
  FaultySensor fault_;
  std::uint64_t count_ = 0;
  ImuReading reading_;
};

/// Motion capture or LiDAR-inertial odometry: the pose of B, late.
class PoseSensor {
 public:
  PoseSensor(const PoseSensorConfig& config, PoseSourceKind kind, double noise_scale,
             const robot::Vector3& attitude_bias_rad, Random noise, Random drift, Random fault);

  /// After each physics step: measures when due, and hands over what has been under way for the latency.
  void step(TimePoint now, const robot::Pose& X_WB);
  /// The newest measurement that has arrived.
  bool has_reading() const { return arrived_ > 0; }
  const PoseReading& reading() const { return reading_; }
  std::uint64_t count() const { return arrived_; }
  void set_fault(const SensorFault& fault, TimePoint now) { fault_.set(fault, now); }

 private:
  PoseReading measure(TimePoint now, const robot::Pose& X_WB);

  static constexpr std::size_t in_flight_max = 256;  // 0.5 s at 500 Hz
  PoseSensorConfig config_;
  PoseSourceKind kind_;
  double scale_;
  robot::Matrix3 R_bias_;
  Random noise_;
  Random drift_random_;
  robot::Vector3 position_bias_;
  robot::Vector3 drift_ = robot::Vector3::Zero();
  Duration latency_;
  int period_steps_;
  int steps_ = 0;
  std::array<PoseReading, in_flight_max> in_flight_{};
  std::size_t oldest_ = 0;
  std::size_t count_ = 0;
  FaultySensor fault_;
  std::uint64_t arrived_ = 0;
  PoseReading reading_;
};

}  // namespace eciton::hal::sim
