// Forward kinematics of a chain to second order.
#include "core/robot/chain_trajectory.hpp"

#include <algorithm>
#include <array>

namespace eciton::robot {
namespace {

/// A frame that moves; everything in world axes.
struct FrameMotion {
  Vector3 p, v, a;
  Matrix3 R;
  Vector3 w, alpha;
};

/// Another frame fixed to the same body, at `offset` (world axes), with axes R_next.
FrameMotion fixed_at(const FrameMotion& f, const Vector3& offset, const Matrix3& R_next) {
  const Vector3 along = f.w.cross(offset);
  return {f.p + offset, f.v + along, f.a + f.alpha.cross(offset) + f.w.cross(along), R_next, f.w, f.alpha};
}

/// From one side of a joint to the other. `axis_W` belongs to both sides; the far side turns about it by
/// `position`, forwards from body to link.
FrameMotion across_joint(const FrameMotion& f, const Vector3& axis_W, const Matrix3& R_next, double velocity,
                         double acceleration) {
  FrameMotion out = f;
  out.R = R_next;
  out.w = f.w + velocity * axis_W;
  // The axis turns with either side alike: its rate is w x axis.
  out.alpha = f.alpha + acceleration * axis_W + velocity * f.w.cross(axis_W);
  return out;
}

FrameMotion body_to_port(const Airframe& airframe, int port, const FrameMotion& body,
                         std::span<const ScalarMotion> joints) {
  const PortGeometry& p = airframe.ports[static_cast<std::size_t>(port)];
  const JointGeometry& joint = airframe.joints[static_cast<std::size_t>(p.joint)];
  const ScalarMotion& q = joints[static_cast<std::size_t>(p.joint)];
  const Matrix3 R_BL = Eigen::AngleAxisd(q.position, joint.axis_B).toRotationMatrix();
  const FrameMotion at_joint = fixed_at(body, body.R * joint.p_BJ_m, body.R);
  const FrameMotion link = across_joint(at_joint, body.R * joint.axis_B, body.R * R_BL, q.velocity, q.acceleration);
  return fixed_at(link, link.R * p.p_JP_m, link.R * p.R_JP);
}

FrameMotion port_to_body(const Airframe& airframe, int port, const FrameMotion& at_port,
                         std::span<const ScalarMotion> joints) {
  const PortGeometry& p = airframe.ports[static_cast<std::size_t>(port)];
  const JointGeometry& joint = airframe.joints[static_cast<std::size_t>(p.joint)];
  const ScalarMotion& q = joints[static_cast<std::size_t>(p.joint)];
  const Matrix3 R_BL = Eigen::AngleAxisd(q.position, joint.axis_B).toRotationMatrix();
  const Matrix3 R_WL = at_port.R * p.R_JP.transpose();
  const FrameMotion link = fixed_at(at_port, -(R_WL * p.p_JP_m), R_WL);
  const Matrix3 R_WB = R_WL * R_BL.transpose();
  const FrameMotion at_joint = across_joint(link, R_WB * joint.axis_B, R_WB, -q.velocity, -q.acceleration);
  return fixed_at(at_joint, -(R_WB * joint.p_BJ_m), R_WB);
}

FrameMotion in_world(const BodyMotion& b) {
  return {b.p_WB, b.v_WB, b.a_WB, b.R_WB, b.R_WB * b.w_WB_B, b.R_WB * b.alpha_WB_B};
}
BodyMotion in_body(const FrameMotion& f) {
  return {f.p, f.v, f.a, f.R, f.R.transpose() * f.w, f.R.transpose() * f.alpha};
}

/// Bodies of all members from that of one.
void chain_bodies(const Airframe& airframe, std::size_t from, const FrameMotion& body,
                  std::span<const ScalarMotion> joints, std::span<FrameMotion> bodies) {
  const std::size_t n = airframe.joints.size();
  const auto of = [&](std::size_t i) { return joints.subspan(i * n, n); };
  bodies[from] = body;
  for (std::size_t i = from; i + 1 < bodies.size(); ++i) {
    bodies[i + 1] = port_to_body(airframe, 1, body_to_port(airframe, 0, bodies[i], of(i)), of(i + 1));
  }
  for (std::size_t i = from; i > 0; --i) {
    bodies[i - 1] = port_to_body(airframe, 0, body_to_port(airframe, 1, bodies[i], of(i)), of(i - 1));
  }
}

}  // namespace

PoseReference composite_reference(const BodyMotion& body, const ComMotion& com) {
  const Vector3 turning = body.w_WB_B.cross(com.c_B);
  const Vector3 v_B = turning + com.c_rate_B;
  const Vector3 a_B = body.alpha_WB_B.cross(com.c_B) + body.w_WB_B.cross(turning) +
                      2 * body.w_WB_B.cross(com.c_rate_B) + com.c_acceleration_B;
  return {body.p_WB + body.R_WB * com.c_B,
          body.v_WB + body.R_WB * v_B,
          body.a_WB + body.R_WB * a_B,
          body.R_WB,
          body.w_WB_B,
          body.alpha_WB_B};
}

BodyMotion body_motion(const PoseReference& composite, const ComMotion& com) {
  const BodyMotion origin{Vector3::Zero(), Vector3::Zero(),  Vector3::Zero(),
                          composite.R_WM,  composite.w_WM_M, composite.alpha_WM_M};
  const PoseReference offset = composite_reference(origin, com);
  return {composite.p_WM - offset.p_WM,
          composite.v_WM - offset.v_WM,
          composite.a_WM - offset.a_WM,
          composite.R_WM,
          composite.w_WM_M,
          composite.alpha_WM_M};
}

void chain_references(const Airframe& airframe, std::size_t base, const PoseReference& base_reference,
                      std::span<const ScalarMotion> joints, std::span<PoseReference> references) {
  const std::size_t n = airframe.joints.size(), members = std::min(references.size(), members_max);
  if (base >= members) return;
  std::array<FrameMotion, members_max> bodies;
  const ComMotion base_com = com_motion_B(airframe, joints.subspan(base * n, n));
  chain_bodies(airframe, base, in_world(body_motion(base_reference, base_com)), joints,
               std::span(bodies).first(members));
  for (std::size_t i = 0; i < members; ++i) {
    references[i] = composite_reference(in_body(bodies[i]), com_motion_B(airframe, joints.subspan(i * n, n)));
  }
  references[base] = base_reference;
}

PoseReference base_reference_from(const Airframe& airframe, std::size_t base, std::size_t member,
                                  const PoseReference& member_reference, std::span<const ScalarMotion> joints) {
  std::array<PoseReference, members_max> references;
  const std::size_t n = airframe.joints.size();
  const std::size_t members = n > 0 ? std::min(joints.size() / n, members_max) : 0;
  if (base >= members || member >= members) return member_reference;
  chain_references(airframe, member, member_reference, joints, std::span(references).first(members));
  return references[base];
}

}  // namespace eciton::robot
