// Complementary attitude filter.
#include "core/robot/attitude_filter.hpp"

#include <cmath>

namespace eciton::robot {

void AttitudeFilter::set(const Matrix3& R_WB) {
  R_WB_ = R_WB;
  ready_ = true;
}

void AttitudeFilter::update(const Vector3& w_B_rad_s, const Vector3& specific_force_B_m_s2, double dt_s) {
  const double norm = specific_force_B_m_s2.norm();
  if (!ready_) {
    if (norm < 0.5 * gravity_m_s2) return;
    // The rotation that turns the measured up onto the world's.
    set(Quaternion::FromTwoVectors(specific_force_B_m_s2, Vector3::UnitZ()).toRotationMatrix());
  }
  Vector3 correction = Vector3::Zero();
  if (std::abs(norm - gravity_m_s2) < config_.gravity_share_max * gravity_m_s2) {
    const Vector3 up_B = R_WB_.transpose().col(2);
    correction = (specific_force_B_m_s2 / norm).cross(up_B);
  }
  bias_ -= config_.bias_rate_1_s2 * dt_s * correction;
  bias_ = bias_.cwiseMax(-config_.bias_rad_s_max).cwiseMin(config_.bias_rad_s_max);
  w_B_ = w_B_rad_s - bias_;
  R_WB_ = Quaternion(R_WB_ * exp_so3((w_B_ + config_.correction_rate_1_s * correction) * dt_s))
              .normalized()
              .toRotationMatrix();
}

}  // namespace eciton::robot
