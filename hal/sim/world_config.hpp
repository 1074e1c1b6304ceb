// What one simulated world is like: its seed, its disturbances, its sensors and where its modules start.
// Defaults are the mismatch preset of the experiments: "honest" noise, bias, delay and model errors.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/config.hpp"

namespace eciton::hal::sim {

inline constexpr std::size_t max_modules = 16;

/// Where a module is when the world starts, level. Below the floor's rest height it is put on the floor.
struct ModuleStart {
  std::uint32_t id = 0;
  std::array<double, 3> p_WB_m{};
  double yaw_rad = 0;
  bool hovering = false;  // rotors already at hover thrust, so that a run may begin in the air

  template <class V>
  void visit_fields(V& v) {
    v("id", id);
    v("position_m", p_WB_m);
    v("yaw_rad", yaw_rad);
    v("hovering", hovering);
  }
};

/// White noise per sample (standard deviations, per axis) and a bias drawn once per module.
struct ImuConfig {
  double rate_Hz = 500;
  double accelerometer_noise_m_s2 = 0.1;
  double accelerometer_bias_m_s2 = 0.05;
  double gyroscope_noise_rad_s = 0.01;
  double gyroscope_bias_rad_s = 0.002;

  template <class V>
  void visit_fields(V& v) {
    v("rate_Hz", rate_Hz, in_range(50, 1000));
    v("accelerometer_noise_m_s2", accelerometer_noise_m_s2, in_range(0, 10));
    v("accelerometer_bias_m_s2", accelerometer_bias_m_s2, in_range(0, 2));
    v("gyroscope_noise_rad_s", gyroscope_noise_rad_s, in_range(0, 1));
    v("gyroscope_bias_rad_s", gyroscope_bias_rad_s, in_range(0, 0.2));
  }
};

/// A pose sensor: white noise per measurement, a constant bias, and a drift (Ornstein-Uhlenbeck, its
/// length cut off at drift_m_max). All standard deviations per axis.
struct PoseSensorConfig {
  double rate_Hz = 100;
  double latency_s = 0.010;
  double position_noise_m = 0.0005;
  double attitude_noise_rad = 0.003;
  double position_bias_m = 0.001;
  double drift_m = 0;
  double drift_time_s = 10;
  double drift_m_max = 0.028;

  template <class V>
  void visit_fields(V& v) {
    v("rate_Hz", rate_Hz, in_range(1, 500));
    v("latency_s", latency_s, in_range(0, 0.5));
    v("position_noise_m", position_noise_m, in_range(0, 1));
    v("attitude_noise_rad", attitude_noise_rad, in_range(0, 0.5));
    v("position_bias_m", position_bias_m, in_range(0, 1));
    v("drift_m", drift_m, in_range(0, 1));
    v("drift_time_s", drift_time_s, in_range(0.1, 1000));
    v("drift_m_max", drift_m_max, in_range(0, 1));
  }
};

inline PoseSensorConfig lio_defaults() {
  return {.rate_Hz = 20,
          .latency_s = 0.060,
          .position_noise_m = 0.003,
          .attitude_noise_rad = 0.003,
          .position_bias_m = 0,
          .drift_m = 0.01};
}

/// Noise of the servos' and ESCs' own readings, standard deviations.
struct ReadingConfig {
  double thrust_noise_N = 0.02;
  double gimbal_noise_rad = 0.001;
  double joint_noise_rad = 0.0005;
  double joint_velocity_noise_rad_s = 0.01;
  double joint_torque_noise_Nm = 0.02;

  template <class V>
  void visit_fields(V& v) {
    v("thrust_noise_N", thrust_noise_N, in_range(0, 5));
    v("gimbal_noise_rad", gimbal_noise_rad, in_range(0, 0.1));
    v("joint_noise_rad", joint_noise_rad, in_range(0, 0.1));
    v("joint_velocity_noise_rad_s", joint_velocity_noise_rad_s, in_range(0, 1));
    v("joint_torque_noise_Nm", joint_torque_noise_Nm, in_range(0, 1));
  }
};

/// Six cells. The figures are those of five to seven minutes of flight; no airframe's data give them.
struct BatteryConfig {
  double start_V = 25.0;         // without load
  double discharge_V_min = 0.4;  // per minute of hovering
  double sag_V = 0.4;            // under the load of hovering
  double noise_V = 0.02;         // of its reading

  template <class V>
  void visit_fields(V& v) {
    v("start_V", start_V, in_range(18, 26));
    v("discharge_V_min", discharge_V_min, in_range(0, 60));
    v("sag_V", sag_V, in_range(0, 5));
    v("noise_V", noise_V, in_range(0, 1));
  }
};

struct WorldConfig {
  std::uint64_t seed = 1;
  std::uint64_t start_ns = 0;      // the world's time when it begins
  std::string world = "honest";    // ideal: model parameters equal the controllers' (for debugging)
  bool full_joint_offset = false;  // honest: joints' offsets all at their upper bound
  bool wakes = true;               // rotor wakes push neighbours
  double gust_N = 0;               // standard deviation per horizontal axis, half of it vertical
  std::array<double, 3> wind_N{};  // constant force on every module
  std::string sensing = "mocap";
  double noise = 1;  // scales every sensor's noise, bias and drift
  bool floor = true;
  std::string break_what;  // "weld-off": latches report, but never hold
  ImuConfig imu;
  PoseSensorConfig mocap;
  PoseSensorConfig lio = lio_defaults();
  ReadingConfig readings;
  BatteryConfig battery;
  std::vector<ModuleStart> modules;

  const PoseSensorConfig& pose_sensor() const { return sensing == "lio" ? lio : mocap; }

  template <class V>
  void visit_fields(V& v) {
    v("seed", seed);
    v("start_ns", start_ns);
    v("world", world, one_of({"honest", "ideal"}));
    v("full_joint_offset", full_joint_offset);
    v("wakes", wakes);
    v("gust_N", gust_N, in_range(0, 20));
    v("wind_N", wind_N);
    v("sensing", sensing, one_of({"mocap", "lio"}));
    v("noise", noise, in_range(0, 10));
    v("floor", floor);
    v("break", break_what, one_of({"", "weld-off"}));
    v("imu", imu);
    v("mocap", mocap);
    v("lio", lio);
    v("readings", readings);
    v("battery", battery);
    v("modules", modules);
  }
};

}  // namespace eciton::hal::sim
