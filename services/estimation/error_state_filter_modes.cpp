// What the error-state filter is worth now: its modes, and the estimate it gives.
#include <algorithm>

#include "services/estimation/error_state_filter.hpp"

namespace eciton::estimation {
namespace {

// Where the parts of the error state begin.
constexpr int P = 0, V = 3, R = 6, BG = 9;

const Vector3 gravity_W(0, 0, -robot::gravity_m_s2);

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

bool ErrorStateFilter::converged() const {
  const auto within = [&](int k, double std_max) {
    return newest().P.diagonal().segment<3>(k).maxCoeff() < std_max * std_max;
  };
  return good_since_start_ >= config_.ready_measurements && within(P, config_.ready_position_std_m) &&
         within(V, config_.ready_velocity_std_m_s) && within(R, config_.ready_attitude_std_rad);
}

void ErrorStateFilter::refresh_mode() {
  if (!started_) {
    mode_ = was_ready_ ? FilterMode::lost : FilterMode::initialising;
    return;
  }
  const double age_s = seconds(newest().imu.stamp_ns - last_good_ns_);
  const double position_variance = newest().P.diagonal().segment<3>(P).maxCoeff();
  if (age_s > config_.lost_s || position_variance > config_.lost_position_std_m * config_.lost_position_std_m) {
    mode_ = FilterMode::lost;
  } else if (mode_ == FilterMode::initialising || mode_ == FilterMode::lost) {
    mode_ = converged() ? FilterMode::ready : FilterMode::initialising;
  } else {
    mode_ = age_s > config_.dead_reckoning_s ? FilterMode::dead_reckoning : FilterMode::ready;
  }
  was_ready_ = was_ready_ || mode_ == FilterMode::ready;
}

Estimate ErrorStateFilter::estimate() const {
  const Entry& e = newest();
  Estimate out;
  out.stamp_ns = e.imu.stamp_ns;
  out.mode = mode_;
  out.X_WB = {e.x.p, e.x.R};
  out.v_WB = e.x.v;
  out.a_WB = e.x.R * (e.imu.specific_force_B_m_s2 - e.x.ba) + gravity_W;
  out.w_WB_B = e.imu.w_WB_B_rad_s - e.x.bg;
  out.gyroscope_bias = e.x.bg;
  out.accelerometer_bias = e.x.ba;
  // The rate's noise is that of one sample; its spacing is taken from the buffer.
  const Entry& before = buffer_[(head_ + buffer_.size() - 1) % buffer_.size()];
  const double dt = count_ > 1 ? seconds(e.imu.stamp_ns - before.imu.stamp_ns) : 0.002;
  const double rate_variance = config_.gyroscope_noise_rad_s_rtHz * config_.gyroscope_noise_rad_s_rtHz / dt;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    out.variance[i] = std::max(e.P(P + k, P + k), position_std_m_ * position_std_m_);
    out.variance[i + 3] = std::max(e.P(R + k, R + k), attitude_std_rad_ * attitude_std_rad_);
    out.variance[i + 6] = e.P(V + k, V + k);
    out.variance[i + 9] = e.P(BG + k, BG + k) + rate_variance;
  }
  out.pose_age_s = started_ ? seconds(e.imu.stamp_ns - last_good_ns_) : 0;
  return out;
}

}  // namespace eciton::estimation
