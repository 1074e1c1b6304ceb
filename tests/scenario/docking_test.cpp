// Chains that dock and part, and what happens when that goes wrong on the way.
#include <gtest/gtest.h>

#include "tests/scenario/fleet.hpp"

namespace eciton::deploy {
namespace {

class ChainDockingTest : public ::testing::Test {
 protected:
  void fly(const SimulationConfig& config) {
    simulation_ = std::make_unique<Simulation>(config);
    pilot_ = std::make_unique<Pilot>(*simulation_);
    pilot_->bring_to_hover(heights(static_cast<std::uint32_t>(simulation_->size())));
  }
  void dock(std::uint32_t follower, std::uint32_t target, std::size_t members) {
    const GoalReport report = pilot_->dock(follower, target, 60);
    ASSERT_EQ(report.progress, GoalProgress::succeeded) << report.what << ": " << report.reason;
    ASSERT_TRUE(pilot_->wait_until([&] { return members_of(follower) == members && agreed(follower); }, 2));
    pilot_->wait(1);
  }
  std::size_t members_of(std::uint32_t id) const { return pilot_->fleet().find(id)->view->members.size(); }
  /// All members of its chain fly by its view.
  bool agreed(std::uint32_t id) const {
    const msg::ChainView& view = *pilot_->fleet().find(id)->view;
    return std::all_of(view.members.begin(), view.members.end(), [&](std::uint32_t member) {
      return pilot_->fleet().find(member)->view->active_epoch == view.active_epoch;
    });
  }
  bool wait_for_phase(std::uint32_t id, msg::DockingPhase phase, double limit_s) {
    return pilot_->wait_until(
        [&] {
          const auto& docking = pilot_->fleet().find(id)->docking;
          return docking && docking->phase == phase;
        },
        limit_s);
  }
  void expect_refusal(std::uint64_t goal, const std::string& part) {
    EXPECT_EQ(pilot_->follow(goal, 5), GoalProgress::refused);
    EXPECT_NE(pilot_->op().report(goal)->reason.find(part), std::string::npos) << pilot_->op().report(goal)->reason;
  }
  robot::Vector3 place(std::uint32_t id) const { return simulation_->world().truth_pose(id).p_WM_m; }

  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<Pilot> pilot_;
};

TEST_F(ChainDockingTest, AChainDocksToAModuleByTheEndThatHasThePort) {
  fly(row_of(3, 11));
  dock(3, 2, 2);
  const auto before = place(1);
  // Module 3 is asked; the port in front is module 2's.
  const auto goal = pilot_->op().dock(3, 1);
  ASSERT_TRUE(wait_for_phase(2, msg::DockingPhase::align, 2));
  EXPECT_NE(pilot_->fleet().find(3)->docking->role, msg::DockingRole::follower);
  expect_refusal(pilot_->op().go_to(3, {0, 0, 2}, 0, 0), "docking is under way");
  expect_refusal(pilot_->op().morph(3, std::vector<double>{0, 0, 0.1, 0}, 0), "docking is under way");
  expect_refusal(pilot_->op().dock(2, 1), "docking already");
  EXPECT_EQ(pilot_->follow(goal, 60), GoalProgress::succeeded) << pilot_->op().report(goal)->reason;
  ASSERT_TRUE(pilot_->wait_until([&] { return in_one_chain(*pilot_, 3); }, 2));
  EXPECT_EQ(simulation_->world().latched_links(), 2);
  EXPECT_LT((place(1) - before).norm(), 0.3) << "the target holds still, the follower comes";
}

TEST_F(ChainDockingTest, TwoChainsDockPartInTheMiddleAndFlyOn) {
  fly(row_of(4, 12));
  dock(2, 1, 2);
  dock(4, 3, 2);
  const auto docking = pilot_->op().dock(4, 1);
  ASSERT_TRUE(wait_for_phase(2, msg::DockingPhase::align, 2)) << "the target's port is module 2's";
  expect_refusal(pilot_->op().go_to(1, {0, 0, 2}, 0, 0), "docking is under way");
  expect_refusal(pilot_->op().morph(1, std::vector<double>{0, 0, 0.1, 0}, 0), "docking is under way");
  EXPECT_EQ(pilot_->follow(docking, 60), GoalProgress::succeeded) << pilot_->op().report(docking)->reason;
  ASSERT_TRUE(pilot_->wait_until([&] { return in_one_chain(*pilot_, 4); }, 2));
  EXPECT_EQ(simulation_->world().latched_links(), 3);

  pilot_->wait(2);
  const auto left = place(4), right = place(1);
  const auto goal = pilot_->op().undock(3, 2);
  double held_m = 0, force_N = 0;
  pilot_->wait_until(
      [&] {
        held_m = std::max(held_m, (place(1) - right).norm());
        for (const std::uint32_t male : {2u, 4u}) {
          const auto contact = simulation_->world().truth_contact(male, 0);
          if (contact) force_N = std::max(force_N, contact->wrench_P_W.force.norm());
        }
        return is_over(pilot_->op().report(goal)->progress);
      },
      30);
  ASSERT_EQ(pilot_->op().report(goal)->progress, GoalProgress::succeeded) << pilot_->op().report(goal)->reason;
  EXPECT_EQ(simulation_->world().latched_links(), 2);
  EXPECT_EQ(members_of(1), 2u);
  EXPECT_EQ(members_of(4), 2u);
  EXPECT_TRUE(agreed(1) && agreed(4));
  EXPECT_LT(held_m, 0.15) << "the part that was left does not move";
  EXPECT_LT(force_N, 6) << "and neither is pulled about";
  EXPECT_NEAR((place(4) - left).norm(), 0.5, 0.15) << "the part that was named goes as a whole";

  for (const std::uint32_t id : {4u, 1u}) {
    const auto from = place(id);
    ASSERT_EQ(pilot_->follow(pilot_->op().go_to(id, {from.x(), from.y(), from.z() + 0.3}, 0, 0.2), 20),
              GoalProgress::succeeded);
    EXPECT_NEAR(place(id).z(), from.z() + 0.3, 0.05);
  }
}

TEST_F(ChainDockingTest, BothSidesGiveUpWhenTheTargetFallsSilentMidApproach) {
  fly(row_of(3, 13));
  dock(3, 2, 2);
  const auto goal = pilot_->op().dock(2, 1);
  ASSERT_TRUE(wait_for_phase(2, msg::DockingPhase::approach, 30));
  auto target_states = simulation_->listener(0).create_reader(topics::docking_state);
  simulation_->suspend(0, "radio");
  bool target_idle = false;
  pilot_->wait_until(
      [&] {
        while (const auto sample = target_states.take()) {
          if (sample->value.module_id == 1) target_idle = sample->value.phase == msg::DockingPhase::idle;
        }
        return target_idle && is_over(pilot_->op().report(goal)->progress);
      },
      10);
  EXPECT_TRUE(target_idle) << "free to fly again";
  EXPECT_EQ(pilot_->op().report(goal)->progress, GoalProgress::aborted);
  EXPECT_NE(pilot_->op().report(goal)->reason.find("silent"), std::string::npos);
  pilot_->wait(2);
  EXPECT_EQ(simulation_->world().latched_links(), 1);
  EXPECT_EQ(members_of(2), 2u);
  EXPECT_GT((place(2) - place(1)).norm(), 0.806 + 0.25) << "out of reach again";
  EXPECT_LT((place(2) - place(3)).norm(), 0.9) << "and still a chain";
}

TEST_F(ChainDockingTest, ALatchWithoutAnAgreementLetsGoAgain) {
  SimulationConfig config = row_of(3, 14);
  config.mute_claims = {1};  // nobody hears that the target has latched
  fly(config);
  dock(3, 2, 2);
  const auto goal = pilot_->op().dock(3, 1);
  EXPECT_TRUE(pilot_->wait_until([&] { return simulation_->world().latched_links() == 2; }, 30));
  EXPECT_EQ(pilot_->follow(goal, 30), GoalProgress::aborted);
  EXPECT_NE(pilot_->op().report(goal)->reason.find("agree"), std::string::npos) << pilot_->op().report(goal)->reason;
  EXPECT_EQ(simulation_->world().latched_links(), 1);
  EXPECT_EQ(members_of(2), 2u);
  EXPECT_FALSE(pilot_->fleet().find(1)->in_chain());
  EXPECT_GT((place(2) - place(1)).norm(), 0.806 + 0.3);
}

TEST_F(ChainDockingTest, AChainDoesNotDockToItself) {
  fly(row_of(2, 15));
  dock(2, 1, 2);
  expect_refusal(pilot_->op().dock(1, 2), "ring");
}

}  // namespace
}  // namespace eciton::deploy
