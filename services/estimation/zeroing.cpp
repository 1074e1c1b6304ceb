// Measuring the observer's bias.
#include "services/estimation/zeroing.hpp"

#include <cmath>

namespace eciton::estimation {

using robot::Vector6;

void Zeroing::begin() {
  measured_s_ = batch_s_ = 0;
  samples_ = batch_samples_ = batches_ = 0;
  batch_sum_.setZero();
  mean_sum_.setZero();
  square_sum_.setZero();
}

void Zeroing::start() {
  begin();
  since_start_s_ = 0;
  interruptions_ = 0;
  reason_ = "";
  phase_ = ZeroingPhase::measuring;
}

void Zeroing::close_batch() {
  const Vector6 mean = batch_sum_ / batch_samples_;
  mean_sum_ += mean;
  square_sum_ += mean.cwiseAbs2();
  ++batches_;
  batch_s_ = 0;
  batch_samples_ = 0;
  batch_sum_.setZero();
}

void Zeroing::finish() {
  if (batches_ < 2 || samples_ < config_.samples_min) {
    reason_ = "too few wrench samples while zeroing; is the estimator at its rate?";
    phase_ = ZeroingPhase::refused;
    return;
  }
  const Vector6 mean = mean_sum_ / batches_;
  const Vector6 spread = (square_sum_ / batches_ - mean.cwiseAbs2()).cwiseMax(0) * batches_ / (batches_ - 1);
  const Vector6 deviation = (spread / batches_).cwiseSqrt();
  quality_N_ = deviation.head<3>().maxCoeff();
  quality_Nm_ = deviation.tail<3>().maxCoeff();
  if (quality_N_ > config_.quality_N_max || quality_Nm_ > config_.quality_Nm_max) {
    reason_ = "wrench too unsteady to zero; wait for calmer air";
    phase_ = ZeroingPhase::refused;
    return;
  }
  bias_ = {mean.head<3>(), mean.tail<3>()};
  zeroed_ = true;
  phase_ = ZeroingPhase::done;
}

ZeroingPhase Zeroing::update(const robot::Wrench& wrench_W, const robot::Matrix3& R_WM, const robot::Vector3& v_WM,
                             const robot::Vector3& w_WM_M, double dt_s) {
  if (phase_ != ZeroingPhase::measuring) return phase_;
  since_start_s_ += dt_s;
  if (v_WM.norm() > config_.speed_m_s_max || w_WM_M.norm() > config_.rate_rad_s_max) {
    if (samples_ > 0) ++interruptions_;
    begin();
    if (since_start_s_ > config_.timeout_s) {
      reason_ = "moving while zeroing; hover first";
      phase_ = ZeroingPhase::refused;
    }
    return phase_;
  }
  Vector6 sample;
  sample << wrench_W.force, R_WM.transpose() * wrench_W.moment;
  batch_sum_ += sample;
  ++batch_samples_;
  ++samples_;
  batch_s_ += dt_s;
  measured_s_ += dt_s;
  if (batch_s_ >= config_.batch_s - 1e-9) close_batch();
  if (measured_s_ >= config_.duration_s - 1e-9) finish();
  return phase_;
}

}  // namespace eciton::estimation
