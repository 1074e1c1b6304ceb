// The false wrench per error of the model.
#include "core/robot/model_errors.hpp"

namespace eciton::robot {

ModelErrors ModelTolerance::std() const {
  ModelErrors out;
  out.head<error_mass>().setConstant(thrust_share);
  out[error_mass] = mass_share;
  out.segment<3>(error_com).setConstant(com_m);
  out.segment<3>(error_attitude).setConstant(attitude_rad);
  return out;
}

BiasJacobian bias_jacobian(const Airframe& airframe, std::span<const RotorOutput> rotors, const Vector3& com_offset_B,
                           const Matrix3& R_WM) {
  BiasJacobian out = BiasJacobian::Zero();
  Vector3 thrust_M = Vector3::Zero();
  for (std::size_t k = 0; k < rotors.size(); ++k) {
    const Vector3 f_M = thrust_vector_B(rotors[k]);
    const RotorGeometry& rotor = airframe.rotors[k];
    const auto column = static_cast<Eigen::Index>(k);
    out.block<3, 1>(0, column) = f_M;
    out.block<3, 1>(3, column) = (rotor.p_BR_m - com_offset_B).cross(f_M) + rotor.drag_ratio_m * f_M;
    thrust_M += f_M;
  }
  out.block<3, 1>(0, error_mass) = -airframe.mass_kg * gravity_m_s2 * R_WM.row(2).transpose();
  out.block<3, 3>(3, error_com) = out.block<3, 3>(0, error_attitude) = skew(thrust_M);
  return out;
}

Wrench false_wrench_M(const BiasJacobian& jacobian_M, const ModelErrors& errors) {
  const Vector6 sum = jacobian_M * errors;
  return {sum.head<3>(), sum.tail<3>()};
}

}  // namespace eciton::robot
