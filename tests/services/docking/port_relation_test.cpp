// Signs and frames of a docking, against poses of two LEGION modules laid out by hand in the world.
#include "services/docking/port_relation.hpp"

#include <gtest/gtest.h>

#include <array>

#include "core/robot/kinematics.hpp"

namespace eciton::docking {
namespace {

constexpr int male = 0, female = 1;

Pose port_of(const Pose& X_WB, int port) {
  const std::array joints{0.0, 0.0};
  return X_WB * robot::port_pose_B(robot::legion(), port, joints);
}

TEST(PortRelationTest, IsPositiveInFrontOfAMalePort) {
  // The target looks along +x; its male port is at x = .402. The follower stands in front of it, female behind.
  const Pose target{};
  const Pose follower{Vector3(.4020 + .4040 + .25, 0, .0084 - .0094), robot::Matrix3::Identity()};
  const Pose X_TF = port_of(target, male).inverse() * port_of(follower, female);
  const PortRelation r = relation(X_TF, PortKind::male);
  EXPECT_NEAR(r.gap_m, 0.25, 1e-12);
  EXPECT_NEAR(r.radial_m, 0, 1e-12);
  EXPECT_NEAR(r.attitude_rad, 0, 1e-12);
}

TEST(PortRelationTest, IsPositiveBehindAFemalePort) {
  const Pose target{};
  const Pose follower{Vector3(-(.4020 + .4040 + .25), 0.03, .0094 - .0084 + .04), robot::Matrix3::Identity()};
  const Pose X_TF = port_of(target, female).inverse() * port_of(follower, male);
  const PortRelation r = relation(X_TF, PortKind::female);
  EXPECT_NEAR(r.gap_m, 0.25, 1e-12);
  EXPECT_NEAR(r.radial_m, 0.05, 1e-12);
}

TEST(PortRelationTest, DoesNotDependOnWhereTheWorldIs) {
  const Pose X_WT{Vector3(3, -2, 5), robot::exp_so3(Vector3(0.1, -0.2, 2.0))};
  const Pose X_TF{Vector3(-0.1, 0.02, 0.01), robot::exp_so3(Vector3(0, 0, 0.3))};
  const Pose X_WF = X_WT * X_TF;
  const PortRelation r = relation(X_WT.inverse() * X_WF, PortKind::female);
  EXPECT_NEAR(r.gap_m, 0.1, 1e-12);
  EXPECT_NEAR(r.attitude_rad, 0.3, 1e-12);
}

TEST(PortRelationTest, CallsAPushWhatDrivesTheFollowerAway) {
  const robot::Matrix3 R_WT = robot::exp_so3(Vector3(0, 0, M_PI / 2));  // T's x is the world's y
  EXPECT_NEAR(push_N(Vector3(1, 4, 2), R_WT, PortKind::male), 4, 1e-12);
  EXPECT_NEAR(push_N(Vector3(1, 4, 2), R_WT, PortKind::female), -4, 1e-12);
}

}  // namespace
}  // namespace eciton::docking
