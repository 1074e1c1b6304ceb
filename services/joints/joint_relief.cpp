// The integral of the strain.
#include "services/joints/joint_relief.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::joints {

double weight_torque_Nm(const robot::JointGeometry& joint, double position_rad, const robot::Matrix3& R_WM) {
  const robot::Vector3 lever_B = Eigen::AngleAxisd(position_rad, joint.axis_B) * joint.p_JL_m;
  const robot::Vector3 weight_B = R_WM.transpose() * robot::Vector3(0, 0, -joint.link_mass_kg * robot::gravity_m_s2);
  return -joint.axis_B.dot(lever_B.cross(weight_B));
}

double JointRelief::update(double strain_Nm, double reference_rad_s, double dt_s) {
  const double left_Nm = strain_Nm - config_.friction_Nm_s_rad * reference_rad_s;
  if (!std::isfinite(left_Nm)) return give_rad_;
  give_rad_ -=
      (config_.rate_1_s / config_.stiffness_Nm_rad * left_Nm + give_rad_ / config_.return_time_constant_s) * dt_s;
  give_rad_ = std::clamp(give_rad_, -config_.give_rad, config_.give_rad);
  return give_rad_;
}

double JointRelief::let_go(double dt_s) {
  give_rad_ *= std::exp(-dt_s / config_.return_time_constant_s);
  return give_rad_;
}

}  // namespace eciton::joints
