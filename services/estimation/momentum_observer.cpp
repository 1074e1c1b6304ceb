// The momentum observer.
#include "services/estimation/momentum_observer.hpp"

#include <cmath>

namespace eciton::estimation {

using robot::Vector3;

bool MomentumObserver::update(const MomentumInput& input, double dt_s) {
  const Vector3 p_linear = input.mass_kg * input.v_WM;
  const Vector3 p_angular = input.I_M_kg_m2 * input.w_WM_M;
  const Vector3 u_linear = input.R_WM * input.known_M.force - Vector3(0, 0, input.mass_kg * robot::gravity_m_s2);
  const Vector3 u_angular = input.known_M.moment - input.w_WM_M.cross(p_angular);
  if (!p_linear.allFinite() || !p_angular.allFinite() || !u_linear.allFinite() || !u_angular.allFinite() ||
      !std::isfinite(dt_s)) {
    return false;
  }
  if (has_momentum_ && dt_s > 0) {
    const double a = std::exp(-config_.force_gain_1_s * dt_s), b = std::exp(-config_.moment_gain_1_s * dt_s);
    force_W_ = a * force_W_ + (1 - a) * ((p_linear - p_linear_W_) / dt_s - 0.5 * (u_linear + u_linear_W_));
    moment_M_ = b * moment_M_ + (1 - b) * ((p_angular - p_angular_M_) / dt_s - 0.5 * (u_angular + u_angular_M_));
  }
  p_linear_W_ = p_linear;
  p_angular_M_ = p_angular;
  u_linear_W_ = u_linear;
  u_angular_M_ = u_angular;
  R_WM_ = input.R_WM;
  has_momentum_ = true;
  return true;
}

void MomentumObserver::reset() {
  has_momentum_ = false;
  force_W_.setZero();
  moment_M_.setZero();
}

}  // namespace eciton::estimation
