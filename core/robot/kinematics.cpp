// Kinematics of one module and of a chain.
#include "core/robot/kinematics.hpp"

namespace eciton::robot {
namespace {

Matrix3 joint_rotation(const JointGeometry& joint, double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, joint.axis_B).toRotationMatrix();
}

/// Inertia of a point mass at p about the origin.
Matrix3 point_inertia(double mass_kg, const Vector3& p_m) {
  return mass_kg * (p_m.squaredNorm() * Matrix3::Identity() - p_m * p_m.transpose());
}

}  // namespace

Vector3 com_offset_B(const Airframe& airframe, std::span<const double> joint_rad) {
  Vector3 moved = Vector3::Zero();
  for (std::size_t k = 0; k < airframe.joints.size(); ++k) {
    const JointGeometry& joint = airframe.joints[k];
    moved += joint.link_mass_kg * (joint_rotation(joint, joint_rad[k]) * joint.p_JL_m - joint.p_JL_m);
  }
  return moved / airframe.mass_kg;
}

ComMotion com_motion_B(const Airframe& airframe, std::span<const ScalarMotion> joints) {
  ComMotion out;
  for (std::size_t k = 0; k < airframe.joints.size(); ++k) {
    const JointGeometry& joint = airframe.joints[k];
    const double share = joint.link_mass_kg / airframe.mass_kg;
    const Vector3 arm = joint_rotation(joint, joints[k].position) * joint.p_JL_m;
    const Vector3 across = joint.axis_B.cross(arm);
    out.c_B += share * (arm - joint.p_JL_m);
    out.c_rate_B += share * joints[k].velocity * across;
    out.c_acceleration_B += share * (joints[k].acceleration * across +
                                     joints[k].velocity * joints[k].velocity * joint.axis_B.cross(across));
  }
  return out;
}

Matrix3 composite_inertia(const Airframe& airframe, std::span<const double> joint_rad) {
  // About B's origin: take each link away where it was at zero and put it where it is now; then to the
  // composite centre of mass by the parallel-axis theorem.
  Matrix3 I_B = airframe.I_B_kg_m2;
  for (std::size_t k = 0; k < airframe.joints.size(); ++k) {
    const JointGeometry& joint = airframe.joints[k];
    const Matrix3 R = joint_rotation(joint, joint_rad[k]);
    I_B -= joint.I_L_kg_m2 + point_inertia(joint.link_mass_kg, joint.p_BJ_m + joint.p_JL_m);
    I_B += R * joint.I_L_kg_m2 * R.transpose() + point_inertia(joint.link_mass_kg, joint.p_BJ_m + R * joint.p_JL_m);
  }
  return I_B - point_inertia(airframe.mass_kg, com_offset_B(airframe, joint_rad));
}

Pose port_pose_B(const Airframe& airframe, int port, std::span<const double> joint_rad) {
  const PortGeometry& p = airframe.ports[static_cast<std::size_t>(port)];
  const JointGeometry& joint = airframe.joints[static_cast<std::size_t>(p.joint)];
  const Matrix3 R = joint_rotation(joint, joint_rad[static_cast<std::size_t>(p.joint)]);
  return {joint.p_BJ_m + R * p.p_JP_m, R * p.R_JP};
}

void chain_poses(const Airframe& airframe, std::size_t base, const Pose& X_WB_base, std::span<const double> joint_rad,
                 std::span<Pose> X_WB) {
  const std::size_t n = airframe.joints.size();
  const auto joints_of = [&](std::size_t i) { return joint_rad.subspan(i * n, n); };
  X_WB[base] = X_WB_base;
  for (std::size_t i = base; i + 1 < X_WB.size(); ++i) {
    X_WB[i + 1] =
        X_WB[i] * port_pose_B(airframe, 0, joints_of(i)) * port_pose_B(airframe, 1, joints_of(i + 1)).inverse();
  }
  for (std::size_t i = base; i > 0; --i) {
    X_WB[i - 1] =
        X_WB[i] * port_pose_B(airframe, 1, joints_of(i)) * port_pose_B(airframe, 0, joints_of(i - 1)).inverse();
  }
}

}  // namespace eciton::robot
