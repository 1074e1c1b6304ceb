// Goals that make no sense in the present mode are refused, with the reason.
#include <gtest/gtest.h>

#include "tests/scenario/fleet.hpp"

namespace eciton::deploy {
namespace {

class RefusalTest : public ::testing::Test {
 protected:
  void expect_refusal(std::uint64_t goal, const std::string& part) {
    EXPECT_EQ(pilot_.follow(goal, 10), GoalProgress::refused);
    EXPECT_NE(pilot_.op().report(goal)->reason.find(part), std::string::npos) << pilot_.op().report(goal)->reason;
  }
  Simulation simulation_{row_of(2, 3)};
  Pilot pilot_{simulation_};
};

TEST_F(RefusalTest, OnTheGroundNothingFliesOrDocks) {
  pilot_.wait(2);
  expect_refusal(pilot_.op().take_off(1, 1.5), "arm");
  expect_refusal(pilot_.op().go_to(1, {0, 0, 1}, 0, 0), "arm");
  expect_refusal(pilot_.op().dock(2, 1), "not flying");
  expect_refusal(pilot_.op().undock(2, 1), "no link");
}

TEST_F(RefusalTest, InTheAirWhatCannotBeIsRefused) {
  pilot_.bring_to_hover(heights(2));
  expect_refusal(pilot_.op().arm(1), "flying");
  expect_refusal(pilot_.op().disarm(1), "land");
  expect_refusal(pilot_.op().go_to(1, {80, 0, 1.5}, 0, 0), "x 80 m is outside the fence: -50 to 50 m");
  expect_refusal(pilot_.op().go_to(1, {0, 0, 0.1}, 0, 0), "z 0.1 m is outside the fence");
  expect_refusal(pilot_.op().go_to(1, {0, 0, 1.5}, 0, 7), "speed_m_s 7");
  msg::Waypoint over{.p_WM_m = {0, 0, 1.5}, .q_WM = {0, 1, 0, 0}};
  expect_refusal(pilot_.op().fly_path(1, {&over, 1}, 0), "a tilt of");
  over.q_WM = {0, 0, 0, 0};
  expect_refusal(pilot_.op().fly_path(1, {&over, 1}, 0), "waypoint 1: q_WM has length 0");
  expect_refusal(pilot_.op().dock(1, 1), "two modules");
  expect_refusal(pilot_.op().dock(1, 9), "never heard");
  ASSERT_EQ(pilot_.dock(2, 1, 40).progress, GoalProgress::succeeded);
  ASSERT_TRUE(pilot_.wait_until([&] { return in_one_chain(pilot_, 2); }, 5));
  expect_refusal(pilot_.op().land(1), "undock");
  const std::vector<double> beyond{0, 0, 2.5, 0};
  expect_refusal(pilot_.op().morph(1, beyond, 0), "limit");
}

TEST_F(RefusalTest, StopCutsTheMotorsInAnyMode) {
  pilot_.bring_to_hover(heights(2));
  EXPECT_EQ(pilot_.follow(pilot_.op().stop(1), 5), GoalProgress::succeeded);
  pilot_.wait(2);
  EXPECT_LT(simulation_.world().truth_pose(1).p_WM_m.z(), 0.3);
  EXPECT_GT(simulation_.world().truth_pose(2).p_WM_m.z(), 1.3) << "the other one is not concerned";
}

}  // namespace
}  // namespace eciton::deploy
