// Joint goals: refused with a reason, timed by the slowest, joined on, stopped, begun later.
#include "core/robot/joint_trajectory.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace eciton::robot {
namespace {

const Airframe airframe = legion();

TEST(JointTrajectoryTest, MovesAllJointsTogetherAtTheDefaultRate) {
  JointTrajectory trajectory(airframe);
  trajectory.reset(std::array{0.0, 0.0, 0.0, 0.0}, 0);
  ASSERT_FALSE(trajectory.go(std::array{0.0, 0.0, 0.4, 0.8}, 0, 5, 5));
  const double duration_s = 1.875 * 0.8 / 0.06;
  EXPECT_NEAR(trajectory.end_s(), 5 + duration_s, 1e-9);
  EXPECT_NEAR(trajectory.at(3, 5 + duration_s / 2).velocity, 0.06, 1e-12);
  EXPECT_NEAR(trajectory.at(2, 5 + duration_s / 2).position, 0.2, 1e-12);
  EXPECT_NEAR(trajectory.at(3, 100).position, 0.8, 1e-12);
  EXPECT_TRUE(trajectory.finished(100));
}

TEST(JointTrajectoryTest, ARefusedGoalChangesNothing) {
  JointTrajectory trajectory(airframe);
  trajectory.reset(std::array{0.1, 0.2}, 0);
  EXPECT_EQ(trajectory.go(std::array{1.6, 0.0}, 0, 0, 0)->kind, LimitKind::position);
  EXPECT_EQ(trajectory.go(std::array{0.1}, 0, 0, 0)->kind, LimitKind::count);
  EXPECT_EQ(trajectory.go(std::array{0.1, 0.1}, 9, 0, 0)->kind, LimitKind::rate);
  EXPECT_EQ(trajectory.at(1, 50).position, 0.2);
  EXPECT_TRUE(trajectory.finished(0));
}

TEST(JointTrajectoryTest, AGoalMayBeginLaterAndThePresentMotionGoesOnUntilThen) {
  JointTrajectory trajectory(airframe);
  ASSERT_FALSE(trajectory.go(std::array{0.3, 0.0}, 0, 0, 0));
  JointTrajectory alone = trajectory;
  ASSERT_FALSE(trajectory.go(std::array{-0.2, 0.1}, 0, 1.0, 2.5));
  for (const double t : {1.0, 2.0, 2.499}) EXPECT_EQ(trajectory.at(0, t).position, alone.at(0, t).position);
  EXPECT_NEAR(trajectory.at(0, 2.5).velocity, alone.at(0, 2.5).velocity, 1e-9);
  EXPECT_NEAR(trajectory.at(0, 2.5).acceleration, alone.at(0, 2.5).acceleration, 1e-9);
  EXPECT_NEAR(trajectory.at(0, 100).position, -0.2, 1e-12);
  // A third goal while the second runs starts from the second.
  JointTrajectory second = trajectory;
  ASSERT_FALSE(trajectory.go(std::array{0.0, 0.0}, 0, 4.0, 4.0));
  EXPECT_NEAR(trajectory.at(0, 4.0).position, second.at(0, 4.0).position, 1e-9);
  EXPECT_NEAR(trajectory.at(0, 4.0).velocity, second.at(0, 4.0).velocity, 1e-9);
}

TEST(JointTrajectoryTest, StopsWithinTheAccelerationAndHolds) {
  JointTrajectory trajectory(airframe);
  ASSERT_FALSE(trajectory.go(std::array{0.8, 0.4}, 0, 0, 0));
  const ScalarMotion before = trajectory.at(0, 6);
  trajectory.stop(6);
  EXPECT_NEAR(trajectory.at(0, 6).velocity, before.velocity, 1e-9);
  EXPECT_LT(trajectory.end_s(), 6.5);
  const double rest = trajectory.at(0, 7).position;
  EXPECT_GT(rest, before.position);
  EXPECT_LT(rest, before.position + 0.05);
  EXPECT_EQ(trajectory.at(0, 50).position, rest);
  EXPECT_EQ(trajectory.at(0, 50).velocity, 0);
}

TEST(JointTrajectoryTest, AChainTooTiltedIsRefused) {
  JointTrajectory trajectory(airframe);
  trajectory.reset(std::array<double, 6>{}, 0);
  EXPECT_EQ(trajectory.go(std::array{0.0, 0.0, 0.0, 0.8, 0.0, 0.8}, 0, 0, 0)->kind, LimitKind::chain_tilt);
  trajectory.reset(std::array<double, 6>{}, 1);
  EXPECT_FALSE(trajectory.go(std::array{0.0, 0.0, 0.0, 0.8, 0.0, 0.8}, 0, 0, 0));
}

TEST(JointTrajectoryTest, EqualsTheMotionControlFeedsForward) {
  JointTrajectory trajectory(airframe);
  ASSERT_FALSE(trajectory.go(std::array{0.5, -0.3}, 0.2, 1, 1));
  JointMotion motion;
  motion.go(std::array<ScalarMotion, 2>{}, std::array{0.5, -0.3}, 1, 0.2, 0.5);
  for (double t = 0; t < 8; t += 0.37) {
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(trajectory.at(k, t).position, motion.at(k, t).position);
      EXPECT_EQ(trajectory.at(k, t).acceleration, motion.at(k, t).acceleration);
    }
  }
}

}  // namespace
}  // namespace eciton::robot
