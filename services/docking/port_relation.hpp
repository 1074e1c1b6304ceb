// How a follower's docking port lies to a target's. Frames: T the target's port, F the follower's; both have x
// out of a male port and into a female one, so X_TF is the identity when the two are linked.
#pragma once

#include <cmath>

#include "core/robot/airframe.hpp"

namespace eciton::docking {

using robot::PortKind;
using robot::Pose;
using robot::Vector3;

/// The direction out of the target's port, axes of T: +x from a male port, -x from a female one.
inline Vector3 outward_T(PortKind target_port) {
  return target_port == PortKind::male ? Vector3::UnitX() : Vector3(-Vector3::UnitX());
}

/// All as in maths.md section 3. `gap_m` is positive while the docking points are apart, zero when linked.
struct PortRelation {
  double gap_m = 0;  // along the target's port axis, outward
  double radial_m = 0;
  double attitude_rad = 0;
};

inline PortRelation relation(const Pose& X_TF, PortKind target_port) {
  return {.gap_m = outward_T(target_port).dot(X_TF.p),
          .radial_m = std::hypot(X_TF.p.y(), X_TF.p.z()),
          .attitude_rad = robot::log_so3(X_TF.R).norm()};
}

/// How hard the target pushes the follower away along the port axis, N: from the external force on the
/// follower, world axes, less its bias, and the attitude of the target's port.
inline double push_N(const Vector3& force_W, const robot::Matrix3& R_WT, PortKind target_port) {
  return force_W.dot(R_WT * outward_T(target_port));
}

}  // namespace eciton::docking
