// Sampling, noise and delay of the IMU and the pose sensors.
#include "hal/sim/sensors.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"

namespace eciton::hal::sim {
namespace {

using robot::Vector3;

/// A sensor's period in physics steps of 1 ms: rates are rounded to whole steps.
int steps_per_sample(double rate_Hz) { return std::max(1, static_cast<int>(std::lround(1000.0 / rate_Hz))); }

void copy(const Vector3& from, std::array<double, 3>& to) { Eigen::Map<Vector3>(to.data()) = from; }

}  // namespace

ImuSensor::ImuSensor(const ImuConfig& config, double noise_scale, Random random, Random fault)
    : config_(config),
      scale_(noise_scale),
      random_(random),
      accelerometer_bias_(scale_ * config.accelerometer_bias_m_s2 * random_.normal3()),
      gyroscope_bias_(scale_ * config.gyroscope_bias_rad_s * random_.normal3()),
      period_steps_(steps_per_sample(config.rate_Hz)),
      fault_(fault) {}

void ImuSensor::step(TimePoint now, const Vector3& f_B_m_s2, const Vector3& w_WB_B_rad_s) {
  if (!started_) {
    started_ = true;
    sample(now, f_B_m_s2, w_WB_B_rad_s);
    return;
  }
  sum_ += f_B_m_s2;
  if (++steps_ < period_steps_) return;
  sample(now, sum_ / steps_, w_WB_B_rad_s);
  steps_ = 0;
  sum_.setZero();
}

void ImuSensor::sample(TimePoint now, const Vector3& f_B_m_s2, const Vector3& w_WB_B_rad_s) {
  ImuReading fresh;
  fresh.stamp = now;
  copy(f_B_m_s2 + accelerometer_bias_ + scale_ * config_.accelerometer_noise_m_s2 * random_.normal3(),
       fresh.specific_force_M_m_s2);
  copy(w_WB_B_rad_s + gyroscope_bias_ + scale_ * config_.gyroscope_noise_rad_s * random_.normal3(),
       fresh.w_WM_M_rad_s);
  if (!fault_.befall(fresh, reading_)) return;
  reading_ = fresh;
  ++count_;
}

PoseSensor::PoseSensor(const PoseSensorConfig& config, PoseSourceKind kind, double noise_scale,
                       const Vector3& attitude_bias_rad, Random noise, Random drift, Random fault)
    : config_(config),
      kind_(kind),
      scale_(noise_scale),
      R_bias_(robot::exp_so3(attitude_bias_rad)),
      noise_(noise),
      drift_random_(drift),
      position_bias_(scale_ * config.position_bias_m * drift_random_.normal3()),
      latency_(from_s(config.latency_s)),
      period_steps_(steps_per_sample(config.rate_Hz)),
      fault_(fault) {
  drift_ = scale_ * config.drift_m * drift_random_.normal3();
}

void PoseSensor::step(TimePoint now, const robot::Pose& X_WB) {
  if (steps_ == 0) {
    ECITON_EXPECT(count_ < in_flight_max, "more pose measurements under way than the latency allows");
    if (count_ < in_flight_max) in_flight_[(oldest_ + count_++) % in_flight_max] = measure(now, X_WB);
  }
  steps_ = (steps_ + 1) % period_steps_;
  while (count_ > 0 && in_flight_[oldest_].stamp + latency_ <= now) {
    PoseReading fresh = in_flight_[oldest_];
    if (fault_.befall(fresh, reading_)) {
      reading_ = fresh;
      ++arrived_;
    }
    oldest_ = (oldest_ + 1) % in_flight_max;
    --count_;
  }
}

PoseReading PoseSensor::measure(TimePoint now, const robot::Pose& X_WB) {
  if (config_.drift_m > 0) {
    const double kept = std::exp(-period_steps_ * 1e-3 / config_.drift_time_s);
    drift_ = kept * drift_ + scale_ * config_.drift_m * std::sqrt(1 - kept * kept) * drift_random_.normal3();
    const double limit_m = scale_ * config_.drift_m_max;
    if (drift_.norm() > limit_m) drift_ *= limit_m / drift_.norm();
  }
  PoseReading reading;
  reading.stamp = now;
  reading.source = kind_;
  copy(X_WB.p + position_bias_ + drift_ + scale_ * config_.position_noise_m * noise_.normal3(), reading.p_WB_m);
  const robot::Quaternion q(X_WB.R * R_bias_ *
                            robot::exp_so3(scale_ * config_.attitude_noise_rad * noise_.normal3()));
  reading.q_WB = {q.w(), q.x(), q.y(), q.z()};
  reading.position_std_m = std::hypot(config_.position_noise_m, config_.drift_m);
  reading.attitude_std_rad = config_.attitude_noise_rad;
  return reading;
}

}  // namespace eciton::hal::sim
