// References of the members of a chain while it moves and morphs: (16) of LEGION with its first and second
// derivatives, analytically. Every member computes its own from the base's reference and all joints.
#pragma once

#include <span>

#include "core/robot/kinematics.hpp"
#include "core/robot/trajectory.hpp"

namespace eciton::robot {

/// Motion of B (the body frame, not the composite centre of mass) in W; p, v, a in world axes, w and alpha
/// in body axes.
struct BodyMotion {
  Vector3 p_WB = Vector3::Zero();
  Vector3 v_WB = Vector3::Zero();
  Vector3 a_WB = Vector3::Zero();
  Matrix3 R_WB = Matrix3::Identity();
  Vector3 w_WB_B = Vector3::Zero();
  Vector3 alpha_WB_B = Vector3::Zero();
};

/// From B's origin to the composite centre of mass, which the joints move, and back.
PoseReference composite_reference(const BodyMotion& body, const ComMotion& com);
BodyMotion body_motion(const PoseReference& composite, const ComMotion& com);

/// References of all members (1 to members_max) from that of the base, member `base`, whose reference is
/// exactly `base_reference` again. `joints` holds the members' joints one after another, numbered from the
/// member whose female port is free. M's origin is the composite centre of mass of each member.
void chain_references(const Airframe& airframe, std::size_t base, const PoseReference& base_reference,
                      std::span<const ScalarMotion> joints, std::span<PoseReference> references);

/// The other way round: the base's reference from that of any member, its joints given. A chain that forms
/// in flight starts from where its base is; this tells where that is.
PoseReference base_reference_from(const Airframe& airframe, std::size_t base, std::size_t member,
                                  const PoseReference& member_reference, std::span<const ScalarMotion> joints);

}  // namespace eciton::robot
