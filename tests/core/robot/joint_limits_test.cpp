// Joint limits and the tilt of chains, by hand.
#include "core/robot/joint_limits.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace eciton::robot {
namespace {

std::string text(const LimitFault& fault) {
  char buffer[128];
  return fault.describe(buffer, sizeof buffer);
}

TEST(JointLimitsTest, NamesTheJointItsValueAndItsLimit) {
  const Airframe a = legion();
  EXPECT_FALSE(check_positions(a, std::array{1.5, -1.5, 0.0, 0.3}));
  const auto fault = check_positions(a, std::array{0.0, 0.0, 0.0, -1.62});
  ASSERT_TRUE(fault);
  EXPECT_EQ(text(*fault), "member 2, joint 1: -1.620 rad is beyond its limit of 1.500 rad");
  EXPECT_EQ(text(*check_positions(a, std::array{std::nan(""), 0.0})),
            "member 1, joint 0: the position is not a number");
}

TEST(JointLimitsTest, AWrongNumberOfPositionsIsRefused) {
  const Airframe a = legion();
  EXPECT_EQ(check_positions(a, std::array{0.0, 0.0, 0.0})->kind, LimitKind::count);
  EXPECT_EQ(check_positions(a, {})->kind, LimitKind::count);
  EXPECT_EQ(check_positions(a, std::array<double, 40>{})->kind, LimitKind::count);
}

TEST(JointLimitsTest, RatesArePositiveAndWithinTheServos) {
  const Airframe a = legion();
  EXPECT_FALSE(check_rate(a, 2.6));
  EXPECT_EQ(text(*check_rate(a, 3)), "joint rate 3.000 rad/s; it must be above 0 and at most 2.600 rad/s");
  EXPECT_TRUE(check_rate(a, -0.1));
  EXPECT_TRUE(check_rate(a, std::nan("")));
}

TEST(ChainTiltTest, PitchAnglesAddUpFromTheBase) {
  const Airframe a = legion();
  // Pitch joints of four members; member 0's is free. Seen from member 1: 0.3 one way, 0.5 and 0.9 the other.
  const std::array q{0.0, 0.0, 0.0, 0.3, 0.0, 0.5, 0.0, 0.4};
  const ChainTilt from_second = chain_tilt(a, 1, q);
  EXPECT_EQ(from_second.member, 3u);
  EXPECT_NEAR(from_second.tilt_rad, 0.9, 1e-12);
  EXPECT_NEAR(chain_tilt(a, 0, q).tilt_rad, 1.2, 1e-12);
}

TEST(ChainTiltTest, YawAloneDoesNotTilt) {
  EXPECT_NEAR(chain_tilt(legion(), 1, std::array{0.7, 0.0, -1.0, 0.0, 0.0, 0.0}).tilt_rad, 0, 1e-12);
}

TEST(ChainTiltTest, BeyondTheLimitIsRefusedButWayBackIsOpen) {
  const Airframe a = legion();
  const std::array straight{0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, bent{0.0, 0.0, 0.0, 0.8, 0.0, 0.8};
  const auto fault = check_chain_tilt(a, 0, straight, bent);
  ASSERT_TRUE(fault);
  EXPECT_EQ(text(*fault), "member 3 would tilt 1.600 rad against the base; at most 1.400 rad is flyable");
  EXPECT_FALSE(check_chain_tilt(a, 1, straight, bent));  // 0.8 to either side of the middle
  EXPECT_FALSE(check_chain_tilt(a, 0, straight, std::array{0.0, 0.0, 0.0, 0.7, 0.0, 0.7}));
}

TEST(ChainTiltTest, AChainBentTooFarMayBeStraightened) {
  const Airframe a = legion();
  const std::array bent{0.0, 0.0, 0.0, 0.8, 0.0, 0.8};
  EXPECT_FALSE(check_chain_tilt(a, 0, bent, std::array<double, 6>{}));
  EXPECT_TRUE(check_chain_tilt(a, 0, bent, std::array{0.0, 0.0, 0.0, 0.9, 0.0, 0.9}));
}

TEST(ChainTiltTest, ABendOnTheWayIsFoundThoughBothEndsAreFlyable) {
  // Pitch 1.0, yaw psi, pitch 0.9: the tilt has cosine cos 1 cos .9 - sin 1 sin .9 cos psi, 1.28 rad at
  // psi = +-1.5 and 1.9 rad half-way between.
  const Airframe a = legion();
  const std::array from{0.0, 0.0, 1.5, 1.0, 0.0, 0.9}, to{0.0, 0.0, -1.5, 1.0, 0.0, 0.9};
  const double tilt = std::acos(std::cos(1) * std::cos(.9) - std::sin(1) * std::sin(.9) * std::cos(1.5));
  EXPECT_NEAR(chain_tilt(a, 0, from).tilt_rad, tilt, 1e-12);
  EXPECT_NEAR(chain_tilt(a, 0, to).tilt_rad, tilt, 1e-12);
  EXPECT_TRUE(check_chain_tilt(a, 0, from, to));
}

}  // namespace
}  // namespace eciton::robot
