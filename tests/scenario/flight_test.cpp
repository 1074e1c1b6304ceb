// Flights from the ground to a chain and back.
#include <gtest/gtest.h>

#include "tests/scenario/fleet.hpp"

namespace eciton::deploy {
namespace {

TEST(FlightScenarioTest, OneModuleTakesOffHoversAndLands) {
  Simulation simulation(row_of(1, 7));
  Pilot pilot(simulation);
  pilot.bring_to_hover({1.5});
  pilot.wait(3);
  const auto truth = simulation.world().truth_pose(1);
  EXPECT_NEAR(truth.p_WM_m.z(), 1.5, 0.03);
  EXPECT_LT(truth.v_WM_m_s.norm(), 0.05);
  EXPECT_EQ(pilot.follow(pilot.op().land(1), 20), GoalProgress::succeeded);
  pilot.wait(1);
  EXPECT_LT(simulation.world().truth_pose(1).p_WM_m.z(), 0.2);
}

TEST(FlightScenarioTest, ThreeModulesDockMorphAndSeparate) {
  Simulation simulation(row_of(3, 5));
  Pilot pilot(simulation);
  pilot.bring_to_hover(heights(3));
  ASSERT_EQ(pilot.dock(2, 1, 40).progress, GoalProgress::succeeded) << pilot.dock(2, 1, 1).reason;
  ASSERT_EQ(pilot.dock(3, 2, 40).progress, GoalProgress::succeeded);
  ASSERT_TRUE(pilot.wait_until([&] { return in_one_chain(pilot, 3); }, 5));
  EXPECT_EQ(simulation.world().latched_links(), 2);

  // Female port free first: 3 docked behind 2 behind 1, male into female.
  const auto& members = pilot.fleet().find(1)->view->members;
  EXPECT_EQ(members[0], 3u);
  EXPECT_EQ(members[2], 1u);
  EXPECT_EQ(pilot.fleet().find(1)->view->base_id, 2u);

  const std::vector<double> bent{0, 0, 0.3, 0.2, 0, -0.2};
  ASSERT_EQ(pilot.follow(pilot.op().morph(3, bent, 0), 20), GoalProgress::succeeded);
  EXPECT_NEAR(simulation.world().truth_joint(2, 0).position_rad, 0.3, 0.05);
  double force_N_max = 0;
  pilot.wait_until(
      [&] {
        const auto contact = simulation.world().truth_contact(3, 0);
        if (contact) force_N_max = std::max(force_N_max, contact->wrench_P_W.force.norm());
        return false;
      },
      5);
  EXPECT_LT(force_N_max, 3) << "the contact law holds the preload down";
  EXPECT_GT(force_N_max, 0.001) << "else nothing was measured";

  const auto before = simulation.world().truth_pose(2).p_WM_m;
  ASSERT_EQ(pilot.follow(pilot.op().go_to(2, {before.x() + 0.5, before.y(), before.z()}, 0, 0.2), 20),
            GoalProgress::succeeded);
  EXPECT_NEAR(simulation.world().truth_pose(2).p_WM_m.x(), before.x() + 0.5, 0.05) << "a chain moves with its base";

  ASSERT_EQ(pilot.follow(pilot.op().undock(3, 2), 20), GoalProgress::succeeded);
  ASSERT_EQ(pilot.follow(pilot.op().undock(2, 1), 20), GoalProgress::succeeded);
  EXPECT_EQ(simulation.world().latched_links(), 0);
  EXPECT_TRUE(pilot.wait_until(
      [&] {
        for (std::uint32_t id = 1; id <= 3; ++id) {
          if (pilot.fleet().find(id)->in_chain()) return false;
        }
        return true;
      },
      5));
}

TEST(FlightScenarioTest, AModuleWhoseControlDiesIsFlownDownByItsHardwareHost) {
  Simulation simulation(row_of(1, 9));
  Pilot pilot(simulation);
  pilot.bring_to_hover({1.0});
  simulation.suspend(0, "control");
  pilot.wait(0.5);
  EXPECT_GT(simulation.world().truth_pose(1).p_WM_m.z(), 0.5) << "it descends, it does not fall";
  pilot.wait(6);
  const auto truth = simulation.world().truth_pose(1);
  EXPECT_LT(truth.p_WM_m.z(), 0.25);
  EXPECT_LT(robot::log_so3(truth.X_WB.R).norm(), 0.3) << "level";
}

/// A hover in which a service is killed and comes back after a while; how far the module is from where it was.
double displacement_m(const std::string& service, double away_s, bool from_checkpoint) {
  Simulation simulation(row_of(1, 9));
  Pilot pilot(simulation);
  pilot.bring_to_hover({1.0});
  pilot.wait(1);
  const robot::Vector3 before = simulation.world().truth_pose(1).p_WM_m;
  simulation.kill(0, service);
  pilot.wait(away_s);
  simulation.restart(0, service, from_checkpoint);
  double most_m = 0;
  pilot.wait_until(
      [&] {
        most_m = std::max(most_m, (simulation.world().truth_pose(1).p_WM_m - before).norm());
        return false;
      },
      3);
  const auto there = pilot.op().go_to(1, {before.x() + 0.2, before.y(), before.z()}, 0, 0.3);
  EXPECT_EQ(pilot.follow(there, 10), from_checkpoint ? GoalProgress::succeeded : GoalProgress::refused);
  return most_m;
}

TEST(FlightScenarioTest, ARestartedControlFliesOn) {
  EXPECT_LT(displacement_m("control", 0.3, true), 0.15);
  EXPECT_LT(displacement_m("control", 1.0, true), 0.8);
}

TEST(FlightScenarioTest, ARestartedControlThatKnowsNothingLetsTheHardwareHostLand) {
  // The control of the test above: the module does not stay where it was, and neither does it fall.
  EXPECT_GT(displacement_m("control", 0.3, false), 0.5);
}

/// A service of a chain's member is killed while the chain morphs, and comes back.
class ChainServiceDeathTest : public ::testing::TestWithParam<const char*> {};

TEST_P(ChainServiceDeathTest, TheChainStaysTogetherAndInTheAir) {
  Simulation simulation(row_of(2, 5));
  Pilot pilot(simulation);
  pilot.bring_to_hover(heights(2));
  ASSERT_EQ(pilot.dock(2, 1, 40).progress, GoalProgress::succeeded);
  ASSERT_TRUE(pilot.wait_until([&] { return in_one_chain(pilot, 2); }, 5));
  const std::uint64_t epoch = pilot.fleet().find(1)->view->active_epoch;
  const std::vector<double> bent{0, 0.3, 0.2, 0};
  const auto goal = pilot.op().morph(1, bent, 0);
  pilot.wait(1);
  const auto before = simulation.world().truth_pose(1).p_WM_m;
  simulation.kill(1, GetParam());
  pilot.wait(0.3);
  simulation.restart(1, GetParam());
  // Whoever makes the claims comes back as a new incarnation: a new view of the same chain, and what was being flown
  // on the old one is broken off.
  const bool same_view = GetParam() != std::string("docking");
  EXPECT_EQ(pilot.follow(goal, 20), same_view ? GoalProgress::succeeded : GoalProgress::aborted);
  pilot.wait(5);
  EXPECT_TRUE(in_one_chain(pilot, 2));
  EXPECT_EQ(pilot.fleet().find(1)->view->active_epoch == epoch, same_view);
  EXPECT_LT((simulation.world().truth_pose(1).p_WM_m - before).norm(), 0.1);
  EXPECT_LT(simulation.world().truth_contact(2, 0)->wrench_P_W.force.norm(), 2);
  if (!same_view) return;
  EXPECT_NEAR(simulation.world().truth_joint(2, 1).position_rad + simulation.world().truth_joint(1, 0).position_rad,
              bent[0] + bent[1] + bent[2] + bent[3], 0.1);
}

INSTANTIATE_TEST_SUITE_P(Services, ChainServiceDeathTest,
                         ::testing::Values("estimation", "control", "docking", "joints", "radio"),
                         [](const auto& service) { return std::string(service.param); });

TEST(FlightScenarioTest, AModuleWhoseEstimationDiesDescendsToo) {
  Simulation simulation(row_of(1, 9));
  Pilot pilot(simulation);
  pilot.bring_to_hover({1.0});
  simulation.suspend(0, "estimation");
  pilot.wait(7);
  const auto truth = simulation.world().truth_pose(1);
  EXPECT_LT(truth.p_WM_m.z(), 0.25);
  EXPECT_LT(robot::log_so3(truth.X_WB.R).norm(), 0.3);
}

}  // namespace
}  // namespace eciton::deploy
