// Measuring the observer's bias.
#include "services/estimation/zeroing.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace eciton::estimation {

using robot::Vector6;

Zeroing::Zeroing(const ZeroingConfig& config) : config_(config) {
  config_.batch_s = std::max(config_.batch_s, config_.duration_s / static_cast<double>(batches_max));
}

void Zeroing::begin() {
  measured_s_ = batch_s_ = 0;
  samples_ = batch_samples_ = 0;
  batch_ = {};
  batch_count_ = 0;
}

void Zeroing::start() {
  begin();
  since_start_s_ = 0;
  interruptions_ = 0;
  reason_ = "";
  phase_ = ZeroingPhase::measuring;
}

void Zeroing::close_batch() {
  if (batch_count_ < batches_max) {
    batches_[batch_count_++] = {batch_.wrench_M / batch_samples_, batch_.jacobian_M / batch_samples_};
  }
  batch_ = {};
  batch_s_ = 0;
  batch_samples_ = 0;
}

/// errors = (P^-1 + sum H^T R^-1 H)^-1 sum H^T R^-1 y, in units of the errors' own spreads.
void Zeroing::fit(double batch_std_N, double batch_std_Nm) {
  const robot::ModelErrors std = config_.tolerance.std();
  Vector6 weight;
  weight << robot::Vector3::Constant(1 / batch_std_N), robot::Vector3::Constant(1 / batch_std_Nm);
  Eigen::Matrix<double, robot::model_error_count, robot::model_error_count> information;
  information.setIdentity();
  robot::ModelErrors sum = robot::ModelErrors::Zero();
  for (std::size_t k = 0; k < batch_count_; ++k) {
    const robot::BiasJacobian H = weight.asDiagonal() * batches_[k].jacobian_M * std.asDiagonal();
    information.noalias() += H.transpose() * H;
    sum.noalias() += H.transpose() * weight.cwiseProduct(batches_[k].wrench_M);
  }
  errors_ = std.cwiseProduct(information.llt().solve(sum));
}

Vector6 Zeroing::spread() const {
  Vector6 sum = Vector6::Zero();
  for (std::size_t k = 0; k < batch_count_; ++k) {
    sum += (batches_[k].wrench_M - batches_[k].jacobian_M * errors_).cwiseAbs2();
  }
  return (sum / static_cast<double>(batch_count_ - 1)).cwiseSqrt();
}

void Zeroing::finish() {
  if (batch_count_ < 2 || samples_ < config_.samples_min) {
    reason_ = "too few wrench samples while zeroing; is the estimator at its rate?";
    phase_ = ZeroingPhase::refused;
    return;
  }
  const robot::ModelErrors before = errors_;
  fit(config_.batch_std_N_min, config_.batch_std_Nm_min);
  const Vector6 first = spread();
  fit(std::max(config_.batch_std_N_min, first.head<3>().maxCoeff()),
      std::max(config_.batch_std_Nm_min, first.tail<3>().maxCoeff()));
  const Vector6 deviation = spread() / std::sqrt(static_cast<double>(batch_count_));
  quality_N_ = deviation.head<3>().maxCoeff();
  quality_Nm_ = deviation.tail<3>().maxCoeff();
  if (quality_N_ > config_.quality_N_max || quality_Nm_ > config_.quality_Nm_max) {
    errors_ = before;
    reason_ = "wrench too unsteady to zero; wait for calmer air";
    phase_ = ZeroingPhase::refused;
    return;
  }
  zeroed_ = true;
  phase_ = ZeroingPhase::done;
}

ZeroingPhase Zeroing::update(const robot::Wrench& wrench_M, const robot::BiasJacobian& jacobian_M,
                             const robot::Vector3& v_WM, const robot::Vector3& w_WM_M, double dt_s) {
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
  batch_.wrench_M.head<3>() += wrench_M.force;
  batch_.wrench_M.tail<3>() += wrench_M.moment;
  batch_.jacobian_M += jacobian_M;
  ++batch_samples_;
  ++samples_;
  batch_s_ += dt_s;
  measured_s_ += dt_s;
  if (batch_s_ >= config_.batch_s - 1e-9) close_batch();
  if (measured_s_ >= config_.duration_s - 1e-9) finish();
  return phase_;
}

}  // namespace eciton::estimation
