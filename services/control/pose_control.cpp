// Pose control of one module.
#include "services/control/pose_control.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::control {
namespace {

PoseGains gains(double kp, double ki, double kd, double ap, double ai, double ad) {
  const auto all = [](double x) { return Vector3(Vector3::Constant(x)); };
  return {all(kp), all(ki), all(kd), all(ap), all(ai), all(ad)};
}

Vector3 shortened(const Vector3& v, double norm_max) {
  const double norm = v.norm();
  return norm > norm_max ? Vector3(v * (norm_max / norm)) : v;
}

/// One step of an integral, stored as what it adds to the output. Saturated, it may only shrink.
void integrate(Vector3& integral, const Vector3& gain, const Vector3& error, double dt_s, const Vector3& size_max,
               bool saturated) {
  for (int k = 0; k < 3; ++k) {
    const double step = gain[k] * error[k] * dt_s;
    if (saturated && step * integral[k] >= 0) continue;
    integral[k] = std::clamp(integral[k] + step, -size_max[k], size_max[k]);
  }
}

}  // namespace

PoseGains between(const PoseGains& a, const PoseGains& b, double s) {
  const auto mix = [s](const Vector3& x, const Vector3& y) { return Vector3(x + s * (y - x)); };
  return {mix(a.kp_1_s2, b.kp_1_s2), mix(a.ki_1_s3, b.ki_1_s3), mix(a.kd_1_s, b.kd_1_s),
          mix(a.ap_1_s2, b.ap_1_s2), mix(a.ai_1_s3, b.ai_1_s3), mix(a.ad_1_s, b.ad_1_s)};
}

PoseGains gains_assembled() { return gains(6, 2, 4.5, 40, 8, 12); }
PoseGains gains_free() { return gains(20, 2, 8, 60, 4, 14); }

PoseControl::PoseControl(const PoseControlConfig& config)
    : config_(config), gains_(config.gains), gains_from_(config.gains), gains_to_(config.gains) {}

void PoseControl::set_gains(const PoseGains& new_gains) {
  const PoseGains& to = gains_to_;
  if (new_gains.kp_1_s2 == to.kp_1_s2 && new_gains.ki_1_s3 == to.ki_1_s3 && new_gains.kd_1_s == to.kd_1_s &&
      new_gains.ap_1_s2 == to.ap_1_s2 && new_gains.ai_1_s3 == to.ai_1_s3 && new_gains.ad_1_s == to.ad_1_s) {
    return;
  }
  gains_from_ = gains_;
  gains_to_ = new_gains;
  blend_s_ = 0;
  blending_ = true;
}

void PoseControl::reset() {
  integral_m_s2_.setZero();
  integral_rad_s2_.setZero();
}

void PoseControl::set_integrals(const Vector3& linear_m_s2, const Vector3& angular_rad_s2) {
  integral_m_s2_ = linear_m_s2.cwiseMax(-config_.integral_m_s2_max).cwiseMin(config_.integral_m_s2_max);
  integral_rad_s2_ = angular_rad_s2.cwiseMax(-config_.integral_rad_s2_max).cwiseMin(config_.integral_rad_s2_max);
}

Wrench PoseControl::update(const PoseControlInput& in, double dt_s) {
  if (blending_) {
    blend_s_ += dt_s;
    const double s = config_.gain_blend_s > 0 ? std::min(1.0, blend_s_ / config_.gain_blend_s) : 1.0;
    gains_ = between(gains_from_, gains_to_, s);
    blending_ = s < 1;
  }
  const Matrix3& R = in.state.R_WM;
  const Vector3& w = in.state.w_WM_M;
  const Matrix3 R_MD = R.transpose() * in.reference.R_WM;  // the reference's axes in the module's

  const Vector3 e_r = shortened(in.reference.p_WM - in.state.p_WM, config_.position_error_m_max);
  const Vector3 e_v = in.reference.v_WM - in.state.v_WM;
  const Vector3 e_R = shortened(robot::log_so3(R_MD), config_.attitude_error_rad_max);
  const Vector3 w_d = R_MD * in.reference.w_WM_M;
  const Vector3 e_w = w_d - w;
  if (in.integrate) {
    integrate(integral_m_s2_, gains_.ki_1_s3, e_r, dt_s, config_.integral_m_s2_max, in.force_saturated);
    integrate(integral_rad_s2_, gains_.ai_1_s3, e_R, dt_s, config_.integral_rad_s2_max, in.moment_saturated);
  }

  const Vector3 correction =
      shortened(gains_.kp_1_s2.cwiseProduct(e_r) + gains_.kd_1_s.cwiseProduct(e_v), config_.correction_m_s2_max);
  const Vector3 acceleration = correction + integral_m_s2_ + in.reference.a_WM + Vector3(0, 0, robot::gravity_m_s2);
  // The reference's angular acceleration, seen from axes that turn with the module.
  const Vector3 alpha_ff = R_MD * in.reference.alpha_WM_M - w.cross(w_d);
  const Vector3 alpha =
      gains_.ap_1_s2.cwiseProduct(e_R) + integral_rad_s2_ + gains_.ad_1_s.cwiseProduct(e_w) + alpha_ff;
  return {R.transpose() * (in.mass_kg * acceleration + in.feed_forward_W.force),
          in.I_M_kg_m2 * alpha + w.cross(in.I_M_kg_m2 * w) + R.transpose() * in.feed_forward_W.moment};
}

}  // namespace eciton::control
