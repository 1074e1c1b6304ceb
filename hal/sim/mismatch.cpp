// The draw of the model errors and what they make of a module's mass distribution.
#include "hal/sim/mismatch.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace eciton::hal::sim {
namespace {

using robot::Matrix3;
using robot::Vector3;

/// Inertia of a point mass at p about the origin.
Matrix3 point_inertia(double mass_kg, const Vector3& p_m) {
  return mass_kg * (p_m.squaredNorm() * Matrix3::Identity() - p_m * p_m.transpose());
}

/// Inertia I and second moment S of a mass distribution: I = tr(S) 1 - S, and back.
Matrix3 second_moment(const Matrix3& I) { return 0.5 * I.trace() * Matrix3::Identity() - I; }
Matrix3 inertia(const Matrix3& S) { return S.trace() * Matrix3::Identity() - S; }

}  // namespace

Mismatch draw_mismatch(const robot::Airframe& airframe, Random random, bool full_joint_offset) {
  Mismatch m;
  for (double& scale : m.thrust_scale) scale = random.uniform(0.95, 1.05);
  m.mass_scale = random.uniform(0.97, 1.03);
  m.second_moment_scale = random.uniform3(0.97, 1.03);
  // 3 % of what? A centre of mass has no length of its own; the radius of gyration is the length that
  // says how the mass is spread, and the least of the three keeps the error at what weighing a module
  // on knife edges leaves: 3.1 mm for LEGION, 0.12 Nm at hover.
  const double I_min = Eigen::SelfAdjointEigenSolver<Matrix3>(airframe.I_B_kg_m2).eigenvalues().minCoeff();
  const double com_m = 0.03 * std::sqrt(I_min / airframe.mass_kg);
  m.p_B_com_m = random.uniform3(-com_m, com_m);
  const Vector3 direction = random.normal3().normalized();
  m.attitude_bias_rad = random.uniform(0, 0.010) * direction;
  for (double& offset : m.joint_offset_rad) {
    offset = random.uniform(-0.020, 0.020);
    if (full_joint_offset) offset = 0.020;
  }
  return m;
}

TrueInertia true_inertia(const robot::Airframe& airframe, const Mismatch& mismatch) {
  const double mass_kg = mismatch.mass_scale * airframe.mass_kg;
  // Stretching the second moment along the axes keeps the inertia physical (triangle inequality) for
  // any scale; scaling the inertia's own entries would not.
  const Matrix3 stretch = mismatch.second_moment_scale.cwiseSqrt().asDiagonal();
  const Matrix3 I_com = inertia(stretch * second_moment(airframe.I_B_kg_m2) * stretch);

  TrueInertia out;
  out.link_scale = mismatch.mass_scale;
  out.body_mass_kg = mass_kg;
  Vector3 first_moment = mass_kg * mismatch.p_B_com_m;
  Matrix3 I_B = I_com + point_inertia(mass_kg, mismatch.p_B_com_m);
  for (const robot::JointGeometry& joint : airframe.joints) {
    const double link_kg = out.link_scale * joint.link_mass_kg;
    const Vector3 p_BL_m = joint.p_BJ_m + joint.p_JL_m;
    out.body_mass_kg -= link_kg;
    first_moment -= link_kg * p_BL_m;
    I_B -= out.link_scale * joint.I_L_kg_m2 + point_inertia(link_kg, p_BL_m);
  }
  out.p_B_body_com_m = first_moment / out.body_mass_kg;
  out.I_body_kg_m2 = I_B - point_inertia(out.body_mass_kg, out.p_B_body_com_m);
  return out;
}

}  // namespace eciton::hal::sim
