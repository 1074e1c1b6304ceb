// Where a module's parts are, given its joint angles, and where a chain's members are, given its base.
#pragma once

#include <span>

#include "core/robot/airframe.hpp"
#include "core/robot/minimum_jerk.hpp"

namespace eciton::robot {

/// Offset of the composite centre of mass from B's origin, body axes, m.
Vector3 com_offset_B(const Airframe& airframe, std::span<const double> joint_rad);

/// Offset of the composite centre of mass while the joints move: with its rates, seen from B, body axes.
struct ComMotion {
  Vector3 c_B = Vector3::Zero();
  Vector3 c_rate_B = Vector3::Zero();
  Vector3 c_acceleration_B = Vector3::Zero();
};
ComMotion com_motion_B(const Airframe& airframe, std::span<const ScalarMotion> joints);

/// Inertia of the whole module about its composite centre of mass, body axes, kg m^2.
Matrix3 composite_inertia(const Airframe& airframe, std::span<const double> joint_rad);

/// Pose of a port in B.
Pose port_pose_B(const Airframe& airframe, int port, std::span<const double> joint_rad);

/// (16), LEGION: poses X_WB of the members of a chain, numbered from the one whose female port is free,
/// from the pose of one of them. `joint_rad` holds the members' joints one after another.
/// The male port 0 of member i coincides, axes included, with the female port 1 of member i+1.
void chain_poses(const Airframe& airframe, std::size_t base, const Pose& X_WB_base, std::span<const double> joint_rad,
                 std::span<Pose> X_WB);

}  // namespace eciton::robot
