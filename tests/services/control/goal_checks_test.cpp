// Refusals name the field, where it stands and what would be right.
#include "services/control/goal_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace eciton::control {
namespace {

using robot::Vector3;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, 4> level{1, 0, 0, 0};

GoalLimits room() { return {.fence = {{-5, -6, 0}, {5, 6, 10}}}; }
std::string words(const std::optional<GoalFault>& fault) { return fault ? fault->text.data() : "accepted"; }

TEST(GoalChecksTest, PlacesInsideAreAccepted) {
  EXPECT_EQ(words(check_pose({5, -6, 0.3}, level, 0, room())), "accepted");
  EXPECT_EQ(words(check_pose({0, 0, 10}, {0.6, 0, 0, 0.8}, 3, room())), "accepted");
}

TEST(GoalChecksTest, PlacesOutsideNameTheAxisTheValueAndTheFence) {
  EXPECT_EQ(words(check_pose({61.25, 0, 1}, level, 0, room())), "x 61.25 m is outside the fence: -5 to 5 m");
  EXPECT_EQ(words(check_pose({0, -7, 1}, level, 4, room())), "waypoint 4: y -7 m is outside the fence: -6 to 6 m");
  EXPECT_EQ(words(check_pose({0, 0, 0.1}, level, 0, room())), "z 0.1 m is outside the fence: 0.3 to 10 m");
}

TEST(GoalChecksTest, WhatIsNoNumberOrNoRotationIsRefused) {
  EXPECT_EQ(words(check_pose({0, nan, 1}, level, 0, room())), "p_WM_m is not finite");
  EXPECT_EQ(words(check_pose({0, 0, 1}, {1, 0, nan, 0}, 2, room())), "waypoint 2: q_WM is not finite");
  EXPECT_EQ(words(check_pose({0, 0, 1}, {0, 0, 0, 0}, 0, room())), "q_WM has length 0; a rotation has 1");
  EXPECT_EQ(words(check_pose({0, 0, 1}, {0.5, 0, 0, 0}, 0, room())), "q_WM has length 0.5; a rotation has 1");
  EXPECT_EQ(words(check_pose({0, 0, 1}, {std::numeric_limits<double>::infinity(), 0, 0, 0}, 0, room())),
            "q_WM is not finite");
}

TEST(GoalChecksTest, TakeoffHeights) {
  EXPECT_EQ(words(check_takeoff({0, 0, 0.1}, 1.5, room())), "accepted");
  EXPECT_EQ(words(check_takeoff({0, 0, 0.1}, 0.1, room())), "height 0.1 m; from here 0.3 to 10 m may be asked");
  EXPECT_EQ(words(check_takeoff({0, 0, 2}, 1, room())), "height 1 m; from here 2 to 10 m may be asked");
  EXPECT_EQ(words(check_takeoff({0, 0, 0.1}, 12, room())), "height 12 m; from here 0.3 to 10 m may be asked");
  EXPECT_EQ(words(check_takeoff({0, 0, 0.1}, nan, room())), "the height is not finite");
  EXPECT_EQ(words(check_takeoff({8, 0, 0.1}, 2, room())), "stands outside the fence: x 8 m, which is -5 to 5 m");
}

TEST(GoalChecksTest, SpeedsAndStarts) {
  EXPECT_EQ(words(check_speed(0, room())), "accepted");
  EXPECT_EQ(words(check_speed(2, room())), "accepted");
  for (const double bad : {-0.1, 2.1, nan}) EXPECT_NE(words(check_speed(bad, room())), "accepted");
  EXPECT_EQ(words(check_speed(-1, room())), "speed_m_s -1; it must be at most 2, above 0, or 0 for the default");
  EXPECT_EQ(words(check_start(-1e6, room())), "accepted") << "what should have begun already begins now";
  EXPECT_EQ(words(check_start(3600, room())), "start_ns is 3600 s ahead; at most 60 s");
}

TEST(GoalChecksTest, AMomentOfAWayIsJudgedForEveryMember) {
  robot::HoverReach reach(robot::legion());
  std::array<robot::PoseReference, 2> members;
  members[0].p_WM = {0, 0, 1};
  members[1].p_WM = {4, 0, 1};
  const auto judge = [&] { return words(check_moment(members, 0.3, room(), Vector3::Zero(), reach)); };
  EXPECT_EQ(judge(), "accepted");
  members[1].p_WM.x() = 5.1;
  EXPECT_EQ(judge(), "member 2: on the way x 5.1 m is outside the fence: -5 to 5 m");
  members[1].p_WM.x() = 4;
  members[0].p_WM.z() = 0.2;
  EXPECT_EQ(judge(), "member 1: on the way z 0.2 m is outside the fence: 0.3 to 10 m");
  members[0].p_WM.z() = 1;
  members[1].R_WM = robot::exp_so3({2.5, 0, 0});
  EXPECT_EQ(judge(), "member 2: a tilt of 2.5 rad this way is more than its gimbals and rotors can hold");
}

TEST(GoalChecksTest, TheLongestWordsFitAnAnswer) {
  const auto fault = check_pose({-1.2345678e300, 0, 0}, level, 33, room());
  EXPECT_LT(words(fault).size(), 127u);
  EXPECT_EQ(words(fault).back(), 'm');
}

}  // namespace
}  // namespace eciton::control
