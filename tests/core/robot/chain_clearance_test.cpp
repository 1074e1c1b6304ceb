// Clearance of chains: distances of segments by dense sampling, postures by hand, motions by looking at many moments.
#include "core/robot/chain_clearance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/robot/joint_trajectory.hpp"

namespace eciton::robot {
namespace {

/// Every yaw joint between members the same.
std::vector<double> ring(std::size_t members, double yaw_rad) {
  std::vector<double> q(2 * members, 0.0);
  for (std::size_t i = 0; i + 1 < members; ++i) q[2 * i] = yaw_rad;
  return q;
}

TEST(SegmentDistanceTest, IsTheLeastOfManyPoints) {
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto point = [&] {
    const double x = u(rng), y = u(rng), z = u(rng);
    return Vector3(x, y, z);
  };
  for (int k = 0; k < 40; ++k) {
    const Vector3 a0 = point(), a1 = k % 7 == 0 ? a0 : point(), b0 = point();
    const Vector3 b1 = k % 5 == 0 ? b0 : k % 11 == 0 ? Vector3(b0 + a1 - a0) : point();
    double least = 1e9;
    for (int i = 0; i <= 200; ++i) {
      for (int j = 0; j <= 200; ++j) {
        least = std::min(least, (a0 + (a1 - a0) * i / 200.0 - b0 - (b1 - b0) * j / 200.0).norm());
      }
    }
    const double distance = segment_distance_m(a0, a1, b0, b1);
    EXPECT_LE(distance, least + 1e-12);
    EXPECT_NEAR(distance, least, 0.02);
  }
}

TEST(ChainClearanceTest, AStraightChainIsAsWideApartAsItsRotors) {
  // Rear rotor of one and front rotors of the next but for dock links in line: 0.806 m from body to body, the
  // rotors at +0.0757 and -0.1577 m, and +-0.19 m across.
  const Airframe a = legion();
  const double dx = 0.806 - 0.0757 - 0.1577, dy = 0.19;
  const Nearness near = chain_clearance(a, ring(3, 0));
  EXPECT_NEAR(near.clearance_m, std::hypot(dx, dy) - 0.20, 0.01);
  EXPECT_EQ(near.second, near.first + 1);
}

TEST(ChainClearanceTest, ARingOfFiveMeetsItself) {
  const Airframe a = legion();
  const auto fault = check_chain_clearance(a, ring(5, 0), ring(5, 1.45));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->first, 0u);
  EXPECT_EQ(fault->second, 4u);
  EXPECT_FALSE(check_chain_clearance(a, ring(5, 0), ring(5, 0.9)));
  EXPECT_FALSE(check_chain_clearance(a, ring(3, 0), ring(3, 1.5))) << "three make three sides of a square";
}

TEST(ChainClearanceTest, MotionsAreJudgedAsAThousandMomentsOfThemAre) {
  // Two long arms of a chain of eight that pass through each other: yaws swing from one side to the other.
  const Airframe a = legion();
  std::vector<double> from = ring(8, 0), to = from;
  for (std::size_t i = 0; i < 7; ++i) {
    from[2 * i] = i == 2 || i == 3 || i == 4 ? 1.1 : 0;
    to[2 * i] = i == 2 || i == 3 || i == 4 ? -1.1 : 0;
  }
  // Arms parallel on one side and on the other; from U to U through straight: nothing meets.
  EXPECT_GT(chain_clearance(a, from).clearance_m, 0.03);
  EXPECT_FALSE(check_chain_clearance(a, from, to));
  // Curled up from a wandering line, more or less.
  std::mt19937 rng(9);
  std::uniform_real_distribution<double> u(-1.4, 1.4);
  int refused = 0, accepted = 0;
  for (int k = 0; k < 60; ++k) {
    for (std::size_t i = 0; i < 7; ++i) {
      from[2 * i] = u(rng);
      to[2 * i] = 0.9 + u(rng) / 4;
    }
    if (chain_clearance(a, from).clearance_m < 0.03) continue;
    double least = 1e9;
    std::vector<double> q(from.size());
    for (int s = 0; s <= 1000; ++s) {
      for (std::size_t j = 0; j < q.size(); ++j) q[j] = from[j] + (to[j] - from[j]) * s / 1000;
      least = std::min(least, chain_clearance(a, q).clearance_m);
    }
    const bool no = check_chain_clearance(a, from, to).has_value();
    EXPECT_TRUE(no || least > 0.028) << k << ": " << least;
    EXPECT_TRUE(!no || least < 0.032) << k << ": " << least;
    refused += no ? 1 : 0;
    accepted += no ? 0 : 1;
  }
  EXPECT_GT(refused, 5);
  EXPECT_GT(accepted, 5);
}

TEST(ChainClearanceTest, AChainThatIsTooCloseMayOpen) {
  const Airframe a = legion();
  EXPECT_LT(chain_clearance(a, ring(5, 1.4)).clearance_m, 0.03);
  EXPECT_FALSE(check_chain_clearance(a, ring(5, 1.4), ring(5, 0.8)));
}

TEST(ChainClearanceTest, AGoalInWhichMembersTouchIsRefusedWithTheirNumbers) {
  JointTrajectory joints(legion());
  joints.reset(ring(5, 0), 2);
  const auto fault = joints.go(ring(5, 1.45), 0, 0, 0);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, LimitKind::collision);
  char text[128];
  EXPECT_STREQ(fault->describe(text, sizeof text),
               "members 1 and 5 would touch on the way: less than 0.030 m between them");
  EXPECT_TRUE(joints.finished(0)) << "a refusal changes nothing";
}

}  // namespace
}  // namespace eciton::robot
