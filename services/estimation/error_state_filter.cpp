// Prediction and delayed fusion of the error-state filter; its modes are in error_state_filter_modes.cpp.
#include "services/estimation/error_state_filter.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::estimation {
namespace {

using robot::exp_so3;
using robot::log_so3;
using robot::skew;

// Where the parts of the error state begin.
constexpr int P = 0, V = 3, R = 6, BG = 9, BA = 12;

const Vector3 gravity_W(0, 0, -robot::gravity_m_s2);

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

bool finite(const Pose& X) { return X.p.allFinite() && X.R.allFinite() && std::abs(X.R.determinant() - 1) < 1e-3; }

bool valid(const PoseMeasurement& m) {
  const auto deviation = [](double s) { return std::isfinite(s) && s > 0; };
  return finite(m.X_WB) && deviation(m.position_std_m) && deviation(m.attitude_std_rad);
}

/// A bias that no sensor of the kind has was the filter's own error.
Vector3 plausible(const Vector3& bias, double bias_max) {
  return bias.cwiseAbs().maxCoeff() <= bias_max ? bias : Vector3(Vector3::Zero());
}

Matrix3 orthonormal(const Matrix3& R_WB) { return robot::Quaternion(R_WB).normalized().toRotationMatrix(); }

}  // namespace

ErrorStateFilter::ErrorStateFilter(const ErrorStateFilterConfig& config)
    : config_(config), buffer_(std::max<std::size_t>(config.buffer_samples, 2)) {}

void ErrorStateFilter::predict(const Entry& from, Entry& to) const {
  const double dt = seconds(to.imu.stamp_ns - from.imu.stamp_ns);
  const Nominal& x = from.x;
  const Vector3 w = 0.5 * (from.imu.w_WB_B_rad_s + to.imu.w_WB_B_rad_s) - x.bg;
  const Vector3 f = 0.5 * (from.imu.specific_force_B_m_s2 + to.imu.specific_force_B_m_s2) - x.ba;
  const Matrix3 half_turn = exp_so3(w * (0.5 * dt));
  const Matrix3 R_mid = x.R * half_turn;
  const Matrix3 turn = half_turn * half_turn;
  const Vector3 a = R_mid * f + gravity_W;
  to.x = {x.p + x.v * dt + a * (0.5 * dt * dt), x.v + a * dt, x.R * turn, x.bg, x.ba};

  // P <- F P F^T, by rows and then by columns: F differs from the identity in four blocks only, and each row
  // of blocks reads rows below it, which are still the old ones.
  Covariance& C = to.P;
  C = from.P;
  const Matrix3 from_attitude = -R_mid * skew(f) * dt, from_bias = -R_mid * dt, turn_back = turn.transpose();
  C.middleRows<3>(P) += dt * C.middleRows<3>(V);
  C.middleRows<3>(V) += from_attitude * C.middleRows<3>(R) + from_bias * C.middleRows<3>(BA);
  C.middleRows<3>(R) = (turn_back * C.middleRows<3>(R) - dt * C.middleRows<3>(BG)).eval();
  C.middleCols<3>(P) += dt * C.middleCols<3>(V);
  C.middleCols<3>(V) += C.middleCols<3>(R) * from_attitude.transpose() + C.middleCols<3>(BA) * from_bias.transpose();
  C.middleCols<3>(R) = (C.middleCols<3>(R) * turn - dt * C.middleCols<3>(BG)).eval();

  const auto add = [&](int k, double density) { C.diagonal().segment<3>(k).array() += density * density * dt; };
  add(V, config_.accelerometer_noise_m_s2_rtHz);
  add(R, config_.gyroscope_noise_rad_s_rtHz);
  add(BG, config_.gyroscope_bias_walk_rad_s_rts);
  add(BA, config_.accelerometer_bias_walk_m_s2_rts);
}

ImuVerdict ErrorStateFilter::judge(const ImuSample& sample) {
  if (!sample.specific_force_B_m_s2.allFinite() || !sample.w_WB_B_rad_s.allFinite()) return ImuVerdict::invalid;
  if (count_ == 0 || sample.stamp_ns > newest().imu.stamp_ns) {
    imu_backward_ = 0;
    return ImuVerdict::used;
  }
  if (sample.stamp_ns == newest().imu.stamp_ns) return ImuVerdict::repeated;
  // One sample from the future would shut out all that follow: those behind are believed when they go on in order.
  imu_backward_ = imu_backward_ > 0 && sample.stamp_ns > imu_backward_ns_ ? imu_backward_ + 1 : 1;
  imu_backward_ns_ = sample.stamp_ns;
  if (imu_backward_ < config_.imu_backward_max) return ImuVerdict::backward;
  imu_backward_ = 0;
  begin_anew();
  return ImuVerdict::used;
}

void ErrorStateFilter::begin_anew() {
  ++counters_.imu_gaps;
  const Nominal kept = newest().x;
  count_ = 0;
  buffer_[head_].x = kept;  // the biases are still worth something
  started_ = false;
}

void ErrorStateFilter::forget() {
  count_ = 0;
  started_ = false;
  buffer_[head_] = {};
  rejected_since_ns_.reset();
  good_since_start_ = 0;
  refresh_mode();
}

ImuVerdict ErrorStateFilter::update(const ImuSample& sample) {
  const ImuVerdict verdict = judge(sample);
  if (verdict != ImuVerdict::used) {
    ++counters_.imu_refused;
    return verdict;
  }
  ++counters_.imu;
  if (count_ > 0 && seconds(sample.stamp_ns - newest().imu.stamp_ns) > config_.imu_gap_s_max) begin_anew();
  const std::size_t before = head_;
  if (count_ > 0) head_ = (head_ + 1) % buffer_.size();
  Entry& entry = buffer_[head_];
  entry.imu = sample;
  entry.pose.reset();
  entry.occupied = false;
  if (count_ > 0) {
    if (started_) {
      predict(buffer_[before], entry);
    } else {
      entry.x = buffer_[before].x;
    }
  }
  count_ = std::min(count_ + 1, buffer_.size());
  refresh_mode();
  return ImuVerdict::used;
}

void ErrorStateFilter::replay(std::size_t age) {
  for (; age > 0; --age) {
    Entry& next = at(age - 1);
    predict(at(age), next);
    Innovation again;
    if (next.pose) fuse(next, *next.pose, 1e300, again);
  }
}

std::optional<std::size_t> ErrorStateFilter::find(std::int64_t stamp_ns) const {
  // Ages run from the newest, 0, backwards; the wanted one is the newest not after the stamp.
  std::size_t low = 0, high = count_;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    const Entry& e = buffer_[(head_ + buffer_.size() - middle) % buffer_.size()];
    if (e.imu.stamp_ns <= stamp_ns) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  if (low == count_) return std::nullopt;
  return low;
}

bool ErrorStateFilter::fuse(Entry& entry, const PoseMeasurement& measurement, double gate_chi2,
                            Innovation& innovation) const {
  // The pose lies up to one sample after the entry: it is predicted by what the entry knows, and H with it.
  const double h = seconds(measurement.stamp_ns - entry.imu.stamp_ns);
  Nominal& x = entry.x;
  const Vector3 a = x.R * (entry.imu.specific_force_B_m_s2 - x.ba) + gravity_W;
  const Matrix3 turn = exp_so3((entry.imu.w_WB_B_rad_s - x.bg) * h);
  innovation.value << measurement.X_WB.p - (x.p + x.v * h + a * (0.5 * h * h)),
      log_so3((x.R * turn).transpose() * measurement.X_WB.R);

  using Gain = Eigen::Matrix<double, 15, 6>;
  Eigen::Matrix<double, 6, 15> H = Eigen::Matrix<double, 6, 15>::Zero();
  H.block<3, 3>(0, P).setIdentity();
  H.block<3, 3>(0, V) = h * Matrix3::Identity();
  H.block<3, 3>(3, R) = turn.transpose();
  const double position_std = std::max(measurement.position_std_m, config_.position_std_min_m);
  const double attitude_std = std::max(measurement.attitude_std_rad, config_.attitude_std_min_rad);
  Vector6 noise;
  noise << Vector3::Constant(position_std * position_std), Vector3::Constant(attitude_std * attitude_std);

  const Gain PHt = entry.P * H.transpose();
  innovation.covariance = H * PHt;
  innovation.covariance.diagonal() += noise;
  const Eigen::LDLT<robot::Matrix6> S_inverse(innovation.covariance);
  innovation.chi2 = innovation.value.dot(S_inverse.solve(innovation.value));
  if (!(innovation.chi2 <= gate_chi2)) return false;

  const Gain K = S_inverse.solve(PHt.transpose()).transpose();
  const Eigen::Matrix<double, 15, 1> error = K * innovation.value;
  x.p += error.segment<3>(P);
  x.v += error.segment<3>(V);
  x.R = orthonormal(x.R * exp_so3(error.segment<3>(R)));
  x.bg += error.segment<3>(BG);
  x.ba += error.segment<3>(BA);

  // Joseph's form keeps P positive; then the attitude error is written about the new attitude.
  Covariance A = Covariance::Identity();
  A.noalias() -= K * H;
  Covariance C = A * entry.P * A.transpose();
  C.noalias() += K * noise.asDiagonal() * K.transpose();
  const Matrix3 G = Matrix3::Identity() - 0.5 * skew(error.segment<3>(R));
  C.middleRows<3>(R) = (G * C.middleRows<3>(R)).eval();
  C.middleCols<3>(R) = (C.middleCols<3>(R) * G.transpose()).eval();
  entry.P = 0.5 * (C + C.transpose());
  return true;
}

void ErrorStateFilter::restart(Entry& entry, const PoseMeasurement& measurement) {
  const double h = seconds(measurement.stamp_ns - entry.imu.stamp_ns);
  Nominal& x = entry.x;
  x.p = measurement.X_WB.p;
  x.v.setZero();
  x.bg = plausible(x.bg, config_.bias_kept_stds * config_.gyroscope_bias_std_initial_rad_s);
  x.ba = plausible(x.ba, config_.bias_kept_stds * config_.accelerometer_bias_std_initial_m_s2);
  x.R = orthonormal(measurement.X_WB.R * exp_so3((x.bg - entry.imu.w_WB_B_rad_s) * h));
  const auto squared = [](double s) { return Vector3(Vector3::Constant(s * s)); };
  entry.P.setZero();
  entry.P.diagonal() << squared(std::max(measurement.position_std_m, config_.position_std_min_m)),
      squared(config_.velocity_std_initial_m_s),
      squared(std::max(measurement.attitude_std_rad, config_.attitude_std_min_rad)),
      squared(config_.gyroscope_bias_std_initial_rad_s), squared(config_.accelerometer_bias_std_initial_m_s2);
}

PoseVerdict ErrorStateFilter::start_at(std::size_t age, const PoseMeasurement& measurement) {
  if (was_ready_ || good_since_start_ > 0) ++counters_.restarts;
  // What came before the start says nothing any more.
  count_ = age + 1;
  restart(at(age), measurement);
  at(age).pose.reset();
  at(age).occupied = true;
  replay(age);
  started_ = true;
  good_since_start_ = 1;
  rejected_since_ns_.reset();
  last_good_ns_ = measurement.stamp_ns;
  position_std_m_ = measurement.position_std_m;
  attitude_std_rad_ = measurement.attitude_std_rad;
  mode_ = FilterMode::initialising;  // from dead reckoning too: what is known of the velocity is gone
  refresh_mode();
  return PoseVerdict::started;
}

PoseVerdict ErrorStateFilter::update(const PoseMeasurement& measurement) {
  if (!valid(measurement) || count_ == 0) {
    ++counters_.invalid;
    return PoseVerdict::invalid;
  }
  const std::optional<std::size_t> age = find(measurement.stamp_ns);
  if (!age) {
    ++counters_.too_old;
    return PoseVerdict::too_old;
  }
  if (seconds(measurement.stamp_ns - newest().imu.stamp_ns) > config_.future_s_max) {
    ++counters_.too_new;
    return PoseVerdict::too_new;
  }
  Entry& entry = at(*age);
  if (entry.occupied) {
    ++counters_.repeated;
    return PoseVerdict::repeated;
  }
  if (!started_ || mode_ == FilterMode::lost) return start_at(*age, measurement);

  if (!fuse(entry, measurement, config_.gate_chi2, innovation_)) {
    ++counters_.rejected;
    if (!rejected_since_ns_) rejected_since_ns_ = measurement.stamp_ns;
    if (seconds(measurement.stamp_ns - *rejected_since_ns_) >= config_.restart_rejected_s) {
      return start_at(*age, measurement);
    }
    return PoseVerdict::rejected;
  }
  entry.pose = measurement;
  entry.occupied = true;
  position_std_m_ = measurement.position_std_m;
  attitude_std_rad_ = measurement.attitude_std_rad;
  replay(*age);
  ++counters_.fused;
  ++good_since_start_;
  rejected_since_ns_.reset();
  last_good_ns_ = std::max(last_good_ns_, measurement.stamp_ns);
  refresh_mode();
  return PoseVerdict::fused;
}

}  // namespace eciton::estimation
