// A flight known in closed form, and sensors that measure it with known noise: the independent truth the
// state filter is judged by.
#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <random>

#include "core/robot/rotation_vector.hpp"
#include "services/estimation/error_state_filter.hpp"

namespace eciton::estimation {

struct Truth {
  Vector3 p, v, a;
  Matrix3 R;
  Vector3 w;
};

inline Truth truth_at(double t) {
  const Vector3 amplitude(1.0, 0.6, 0.3), rate(0.8, 1.3, 0.9), turn(0.3, 0.2, 0.5), turn_rate(1.0, 1.4, 0.5);
  Truth out;
  Vector3 phi, phi_t, phi_tt;
  for (int k = 0; k < 3; ++k) {
    const double s = std::sin(rate[k] * t), c = std::cos(rate[k] * t);
    out.p[k] = amplitude[k] * s;
    out.v[k] = amplitude[k] * rate[k] * c;
    out.a[k] = -amplitude[k] * rate[k] * rate[k] * s;
    phi[k] = turn[k] * std::sin(turn_rate[k] * t);
    phi_t[k] = turn[k] * turn_rate[k] * std::cos(turn_rate[k] * t);
    phi_tt[k] = -turn[k] * turn_rate[k] * turn_rate[k] * std::sin(turn_rate[k] * t);
  }
  const robot::AttitudeMotion attitude = robot::attitude_motion(Matrix3::Identity(), phi, phi_t, phi_tt);
  out.R = attitude.R;
  out.w = attitude.w;
  return out;
}

/// What differs from flight to flight. Noise densities are the filter's own unless a test says otherwise.
struct FlightConfig {
  double imu_Hz = 500, pose_Hz = 100, latency_s = 0.01;
  double position_std_m = 1e-3, attitude_std_rad = 3e-3;  // of the noise there is
  double claimed_share = 1;                               // of it, that the measurement admits to
  bool stamped_on_arrival = false;                        // the delay kept secret
  Vector3 attitude_bias_rad = Vector3::Zero();
  double drift_std_m = 0, drift_time_constant_s = 10;  // Ornstein-Uhlenbeck, on the position
  double accelerometer_bias_std = 0.05, gyroscope_bias_std = 0.005;
};

class SimulatedFlight {
 public:
  SimulatedFlight(unsigned seed, const FlightConfig& config, const ErrorStateFilterConfig& filter_config)
      : config_(config), filter_config_(filter_config), filter(filter_config), rng_(seed) {
    gyroscope_bias = noise(config.gyroscope_bias_std);
    accelerometer_bias = noise(config.accelerometer_bias_std);
    drift_ = noise(config.drift_std_m);
  }

  void run_until(double end_s) {
    const double dt = 1 / config_.imu_Hz;
    for (; t < end_s; ++tick_) {
      t = static_cast<double>(tick_) * dt;
      imu(dt);
      if (t >= next_pose_s_ - 1e-9) measure();
      while (!in_flight_.empty() && in_flight_.front().second <= t + 1e-9) {
        if (poses_on && filter.update(in_flight_.front().first) == PoseVerdict::fused && on_fused) {
          on_fused(filter.innovation());
        }
        in_flight_.pop_front();
      }
    }
  }

  Eigen::Matrix<double, 15, 1> error() const {
    const Truth truth = truth_at(t);
    const Estimate e = filter.estimate();
    Eigen::Matrix<double, 15, 1> out;
    out << truth.p - e.X_WB.p, truth.v - e.v_WB, robot::log_so3(e.X_WB.R.transpose() * truth.R),
        gyroscope_bias - e.gyroscope_bias, accelerometer_bias - e.accelerometer_bias;
    return out;
  }

  double t = 0;
  bool poses_on = true;
  Vector3 jump = Vector3::Zero();  // of the pose source's origin
  std::function<void(const Innovation&)> on_fused;
  Vector3 gyroscope_bias, accelerometer_bias;

 private:
  Vector3 noise(double std) {
    std::normal_distribution<double> n(0, 1);
    const double x = n(rng_), y = n(rng_), z = n(rng_);
    return std * Vector3(x, y, z);
  }
  static std::int64_t ns(double s) { return std::llround(s * 1e9) + 1'700'000'000'000'000'000; }

  void imu(double dt) {
    const Truth truth = truth_at(t);
    gyroscope_bias += noise(filter_config_.gyroscope_bias_walk_rad_s_rts * std::sqrt(dt));
    accelerometer_bias += noise(filter_config_.accelerometer_bias_walk_m_s2_rts * std::sqrt(dt));
    ImuSample sample;
    sample.stamp_ns = ns(t);
    sample.specific_force_B_m_s2 = truth.R.transpose() * (truth.a + Vector3(0, 0, robot::gravity_m_s2)) +
                                   accelerometer_bias +
                                   noise(filter_config_.accelerometer_noise_m_s2_rtHz / std::sqrt(dt));
    sample.w_WB_B_rad_s = truth.w + gyroscope_bias + noise(filter_config_.gyroscope_noise_rad_s_rtHz / std::sqrt(dt));
    filter.update(sample);
    const double kept = std::exp(-dt / config_.drift_time_constant_s);
    drift_ = kept * drift_ + noise(config_.drift_std_m * std::sqrt(1 - kept * kept));
  }

  void measure() {
    const double at = next_pose_s_;
    next_pose_s_ += 1 / config_.pose_Hz;
    const Truth truth = truth_at(at);
    PoseMeasurement m;
    m.stamp_ns = ns(config_.stamped_on_arrival ? at + config_.latency_s : at);
    m.X_WB.p = truth.p + jump + drift_ + noise(config_.position_std_m);
    m.X_WB.R = truth.R * robot::exp_so3(config_.attitude_bias_rad) * robot::exp_so3(noise(config_.attitude_std_rad));
    m.position_std_m = config_.claimed_share * config_.position_std_m;
    m.attitude_std_rad = config_.claimed_share * config_.attitude_std_rad;
    in_flight_.emplace_back(m, at + config_.latency_s);
  }

  FlightConfig config_;
  ErrorStateFilterConfig filter_config_;

 public:
  ErrorStateFilter filter;

 private:
  std::mt19937 rng_;
  Vector3 drift_ = Vector3::Zero();
  std::int64_t tick_ = 0;
  double next_pose_s_ = 0.0011;  // not on an IMU sample
  std::deque<std::pair<PoseMeasurement, double>> in_flight_;
};

}  // namespace eciton::estimation
