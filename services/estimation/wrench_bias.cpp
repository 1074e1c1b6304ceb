// The false wrench per error of the model.
#include "services/estimation/wrench_bias.hpp"

namespace eciton::estimation {
namespace {

constexpr int mass_at = static_cast<int>(robot::rotors_max), com_at = mass_at + 1, attitude_at = com_at + 3;

}  // namespace

ModelErrors ModelTolerance::std() const {
  ModelErrors out;
  out.head<mass_at>().setConstant(thrust_share);
  out[mass_at] = mass_share;
  out.segment<3>(com_at).setConstant(com_m);
  out.segment<3>(attitude_at).setConstant(attitude_rad);
  return out;
}

BiasJacobian bias_jacobian(const robot::Airframe& airframe, std::span<const robot::RotorOutput> rotors,
                           const robot::Vector3& com_offset_B, const robot::Matrix3& R_WM) {
  BiasJacobian out = BiasJacobian::Zero();
  robot::Vector3 thrust_M = robot::Vector3::Zero();
  for (std::size_t k = 0; k < rotors.size(); ++k) {
    const robot::Vector3 f_M = robot::thrust_vector_B(rotors[k]);
    const robot::RotorGeometry& rotor = airframe.rotors[k];
    const auto column = static_cast<Eigen::Index>(k);
    out.block<3, 1>(0, column) = f_M;
    out.block<3, 1>(3, column) = (rotor.p_BR_m - com_offset_B).cross(f_M) + rotor.drag_ratio_m * f_M;
    thrust_M += f_M;
  }
  out.block<3, 1>(0, mass_at) = -airframe.mass_kg * robot::gravity_m_s2 * R_WM.row(2).transpose();
  out.block<3, 3>(3, com_at) = out.block<3, 3>(0, attitude_at) = robot::skew(thrust_M);
  return out;
}

}  // namespace eciton::estimation
