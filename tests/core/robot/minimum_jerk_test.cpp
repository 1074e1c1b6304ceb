// Quintics against hand-computed points, numeric differentiation and their limits.
#include "core/robot/minimum_jerk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace eciton::robot {
namespace {

TEST(QuinticTest, RestToRestIsTheKnownPolynomial) {
  const Quintic q({2, 0, 0}, 6, 4);
  for (const double s : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    const ScalarMotion m = q.at(4 * s);
    EXPECT_NEAR(m.position, 2 + 4 * (10 * s * s * s - 15 * std::pow(s, 4) + 6 * std::pow(s, 5)), 1e-12);
    EXPECT_NEAR(m.velocity, (30 * s * s - 60 * s * s * s + 30 * std::pow(s, 4)), 1e-12);
  }
  EXPECT_NEAR(q.at(2).velocity, quintic_speed_factor * 4 / 4, 1e-12);
  const double s_peak = 0.5 - std::sqrt(3) / 6;
  EXPECT_NEAR(q.at(4 * s_peak).acceleration, quintic_acceleration_factor * 4 / 16, 1e-12);
}

TEST(QuinticTest, LeavesFromAnyStateAndDerivativesAreConsistent) {
  const ScalarMotion from{1, -0.4, 0.7};
  const Quintic q(from, 3, 2.5);
  EXPECT_DOUBLE_EQ(q.at(0).velocity, -0.4);
  EXPECT_DOUBLE_EQ(q.at(0).acceleration, 0.7);
  const double h = 1e-5;
  for (double t = 0.1; t < 2.4; t += 0.1) {
    EXPECT_NEAR(q.at(t).velocity, (q.at(t + h).position - q.at(t - h).position) / (2 * h), 1e-8);
    EXPECT_NEAR(q.at(t).acceleration, (q.at(t + h).velocity - q.at(t - h).velocity) / (2 * h), 1e-7);
  }
  EXPECT_NEAR(q.at(2.5 - 1e-12).position, 3, 1e-9);
  EXPECT_NEAR(q.at(2.5 - 1e-9).velocity, 0, 1e-6);
  EXPECT_NEAR(q.at(2.5 - 1e-9).acceleration, 0, 1e-6);
  EXPECT_EQ(q.at(9).velocity, 0);
}

TEST(QuinticTest, NoDurationMeansBeingThere) {
  const Quintic q({1, 0, 0}, 1.5, 0);
  EXPECT_EQ(q.at(0).position, 1.5);
  EXPECT_EQ(q.at(1).velocity, 0);
}

TEST(JointMotionTest, AllArriveTogetherAndTheSlowestRunsAtTheRateLimit) {
  JointMotion motion;
  const std::array<ScalarMotion, 3> from{};
  motion.go(from, std::array{0.8, -0.4, 0.0}, 10, 0.12, 5);
  EXPECT_NEAR(motion.duration_s(), 1.875 * 0.8 / 0.12, 1e-12);
  EXPECT_NEAR(motion.at(0, 10 + motion.duration_s() / 2).velocity, 0.12, 1e-12);
  EXPECT_NEAR(motion.at(1, 10 + motion.duration_s() / 2).velocity, -0.06, 1e-12);
  EXPECT_EQ(motion.at(2, 12).position, 0);
  EXPECT_FALSE(motion.finished(10 + motion.duration_s() - 0.01));
  EXPECT_TRUE(motion.finished(10 + motion.duration_s()));
  EXPECT_EQ(motion.at(0, 9).position, 0);  // not before its start
}

TEST(JointMotionTest, ANewGoalInFullMotionJoinsOnSmoothlyAndHardlyStrainsTheLimits) {
  JointMotion motion;
  const std::array<ScalarMotion, 2> from{{{0.3, 0.10, 0.03}, {0, -0.1, 0}}};
  motion.go(from, std::array{-0.3, 0.2}, 0, 0.12, 0.5);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(motion.at(k, 0).velocity, from[k].velocity, 1e-12);
    EXPECT_NEAR(motion.at(k, 0).acceleration, from[k].acceleration, 1e-12);
    for (double t = 0; t < motion.duration_s(); t += 0.01) {
      EXPECT_LT(std::abs(motion.at(k, t).velocity), 0.12 * 1.1);
      EXPECT_LT(std::abs(motion.at(k, t).acceleration), 0.5 * 1.1);
    }
  }
  EXPECT_NEAR(motion.at(0, 1e3).position, -0.3, 1e-12);
}

TEST(JointMotionTest, StoppingNeverTurnsBack) {
  JointMotion motion;
  const std::array<ScalarMotion, 2> from{{{0.3, 0.12, 0}, {1, -0.06, 0}}};
  motion.stop(from, 5, 0.5);
  EXPECT_NEAR(motion.duration_s(), 1.5 * 0.12 / 0.5, 1e-12);
  for (double t = 5; t < 5.4; t += 0.005) {
    EXPECT_GE(motion.at(0, t).velocity, -1e-12);
    EXPECT_LE(std::abs(motion.at(0, t).acceleration), 0.5 + 1e-9);
    EXPECT_LE(motion.at(1, t).velocity, 1e-12);
  }
  EXPECT_NEAR(motion.at(0, 6).position, 0.3 + 0.12 * 0.36 / 2, 1e-12);
}

TEST(JointMotionTest, TakesAChainOfSixteenModulesOfEightJointsAndNoMore) {
  JointMotion motion;
  std::vector<ScalarMotion> from(200);
  std::vector<double> goal(200, 0.1);
  motion.go(from, goal, 0, 1, 1);
  EXPECT_EQ(motion.size(), 128u);
}

}  // namespace
}  // namespace eciton::robot
