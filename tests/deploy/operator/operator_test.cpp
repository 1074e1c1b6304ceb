// The operator against fake modules over the simulated network, in virtual time.
#include "deploy/operator/operator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/deploy/operator/fake_module.hpp"

namespace eciton::deploy {
namespace {

using bus::sim_network::Network;
using Kind = msg::GoalKind;
using Phase = msg::GoalPhase;

constexpr std::uint32_t domain = 1;

class OperatorTest : public ::testing::Test {
 protected:
  OperatorTest() {
    Network::reset_all();
    Network::of(domain).configure(7, bus::sim_network::Pacing::virtual_time);
    operators_ = std::make_unique<bus::Participant>(participant("operator"));
    op_ = std::make_unique<Operator>(*operators_, OperatorConfig{.first_correlation_id = 100});
  }
  ~OperatorTest() override {
    op_.reset();
    operators_.reset();
    modules_.clear();
    Network::reset_all();
  }

  static bus::ParticipantConfig participant(const std::string& name) {
    return {.vendor = "sim_network", .domain = domain, .name = name, .network_interface = "lo", .peers = {}};
  }
  FakeModule& add_module(std::uint32_t id) {
    modules_.push_back(std::make_unique<FakeModule>(id, participant("m" + std::to_string(id))));
    return *modules_.back();
  }

  /// Everyone for so long, at 100 Hz. The modules' clocks are ahead of the operator's by module_ahead_.
  void run(double seconds) {
    const TimePoint end = now_ + from_s(seconds);
    while (now_ < end) {
      Network::of(domain).advance(now_);
      for (const auto& module : modules_) module->step(module_now());
      op_->poll(now_);
      now_ += 10ms;
    }
  }
  TimePoint module_now() const { return now_ + module_ahead_; }
  GoalProgress progress(std::uint64_t goal) const { return op_->report(goal)->progress; }
  std::string reason(std::uint64_t goal) const { return op_->report(goal)->reason; }

  TimePoint now_{100s};
  Duration module_ahead_{};
  std::unique_ptr<bus::Participant> operators_;
  std::unique_ptr<Operator> op_;
  std::vector<std::unique_ptr<FakeModule>> modules_;
};

TEST_F(OperatorTest, RepeatsAGoalUntilItIsAnsweredAndNoLonger) {
  FakeModule& m1 = add_module(1);
  m1.announce({1}, 0);
  const auto goal = op_->arm(1);
  run(1.3);
  EXPECT_EQ(m1.modes.size(), 3u);  // at once, after 0.5 s and 1 s
  for (const auto& request : m1.modes) EXPECT_EQ(request.correlation_id, goal);
  EXPECT_EQ(progress(goal), GoalProgress::unanswered);
  m1.answer(Kind::mode, goal, Phase::accepted, "", module_now());
  run(2);
  EXPECT_EQ(m1.modes.size(), 3u);
  EXPECT_EQ(progress(goal), GoalProgress::accepted);
  m1.answer(Kind::mode, goal, Phase::succeeded, "", module_now());
  run(0.1);
  EXPECT_EQ(progress(goal), GoalProgress::succeeded);
  EXPECT_NEAR(to_s(op_->report(goal)->ended_at - op_->report(goal)->accepted_at), 2.0, 0.05);
}

TEST_F(OperatorTest, ReportsARefusalWithItsReason) {
  FakeModule& m1 = add_module(1);
  m1.announce({1}, 0);
  const auto goal = op_->take_off(1, 1.5);
  run(0.2);
  ASSERT_EQ(m1.flights.size(), 1u);
  EXPECT_EQ(m1.flights[0].action, msg::FlightAction::takeoff);
  EXPECT_EQ(m1.flights[0].p_WM_m, (std::array<double, 3>{0, 0, 1.5}));
  m1.answer(Kind::flight, goal, Phase::refused, "it is disarmed", module_now());
  run(0.1);
  EXPECT_EQ(progress(goal), GoalProgress::refused);
  EXPECT_EQ(reason(goal), "it is disarmed");
}

TEST_F(OperatorTest, IgnoresAnswersToOtherGoalsAndFromStrangers) {
  FakeModule& m1 = add_module(1);
  FakeModule& m2 = add_module(2);
  m1.announce({1}, 0);
  m2.announce({2}, 0);
  const auto goal = op_->arm(1);
  run(0.1);
  m1.answer(Kind::mode, goal + 1, Phase::refused, "another's", module_now());
  m1.answer(Kind::flight, goal, Phase::refused, "another kind", module_now());
  m2.answer(Kind::mode, goal, Phase::refused, "a stranger's", module_now());
  run(0.1);
  EXPECT_EQ(progress(goal), GoalProgress::unanswered);
}

TEST_F(OperatorTest, DoesNotSendToAModuleThatIsNotHeardAndSaysWhoIs) {
  add_module(3).announce({3}, 0);
  const auto goal = op_->arm(7);
  run(3);
  EXPECT_EQ(progress(goal), GoalProgress::unsent);
  EXPECT_EQ(reason(goal), "it is not heard on the swarm ring; heard: 3");
}

TEST_F(OperatorTest, StopsWithoutHearingTheModuleAndRepeatsFast) {
  const auto goal = op_->stop(7);
  op_->poll(now_);
  EXPECT_EQ(progress(goal), GoalProgress::unanswered) << "sent at the first poll";
  run(1);
  EXPECT_GE(op_->report(goal)->sent, 15u);
  FakeModule& late = add_module(7);
  run(0.2);
  ASSERT_FALSE(late.modes.empty());
  EXPECT_EQ(late.modes[0].action, msg::ModeAction::stop);
}

TEST_F(OperatorTest, MovesAChainABitLaterSoThatItsMembersStartTogether) {
  FakeModule& m1 = add_module(1);
  FakeModule& m2 = add_module(2);
  m1.announce({1, 2}, 42);
  m2.announce({1, 2}, 42);
  run(0.2);
  const auto goal = op_->go_to(2, {1, 2, 3}, 0.5, 0.4);
  run(1.2);
  ASSERT_GE(m2.flights.size(), 2u);
  const double lead_s = 1e-9 * static_cast<double>(m2.flights[0].start_ns - m2.flights[0].stamp_ns);
  EXPECT_NEAR(lead_s, 0.3, 0.02);
  EXPECT_EQ(m2.flights[1].start_ns, m2.flights[0].start_ns) << "a repetition keeps the start";
  EXPECT_NEAR(m2.flights[0].q_WM[3], std::sin(0.25), 1e-12);
  EXPECT_EQ(progress(goal), GoalProgress::unanswered);
}

TEST_F(OperatorTest, SendsAModuleAloneWithoutDelay) {
  FakeModule& m1 = add_module(1);
  m1.announce({1}, 0);
  op_->go_to(1, {1, 2, 3}, 0, 0);
  run(0.1);
  ASSERT_EQ(m1.flights.size(), 1u);
  EXPECT_EQ(m1.flights[0].start_ns, 0);
}

TEST_F(OperatorTest, GivesAMorphTheEpochOfTheChain) {
  FakeModule& m1 = add_module(1);
  FakeModule& m2 = add_module(2);
  m1.announce({2, 1}, 42);
  m2.announce({2, 1}, 42);
  run(0.2);
  const std::array<double, 4> angles{0.4, 0, 0, 0.1};
  op_->morph(1, angles, 0.12);
  run(0.3);
  ASSERT_EQ(m1.morphs.size(), 1u);
  EXPECT_EQ(m1.morphs[0].epoch, 42u);
  EXPECT_EQ(m1.morphs[0].rate_rad_s, 0.12);
  EXPECT_TRUE(std::equal(angles.begin(), angles.end(), m1.morphs[0].joint_position_rad.begin()));
  EXPECT_GT(m1.morphs[0].start_ns, m1.morphs[0].stamp_ns);
}

TEST_F(OperatorTest, RefusesAMorphWithAnotherNumberOfJoints) {
  FakeModule& m1 = add_module(1);
  m1.announce({1, 2, 3}, 42);
  const auto goal = op_->morph(1, std::array{0.1, 0.2, 0.3, 0.4}, 0);
  run(0.3);
  EXPECT_TRUE(m1.morphs.empty());
  EXPECT_EQ(progress(goal), GoalProgress::refused);
  EXPECT_EQ(reason(goal), "4 joint angles for a chain of 3; expected 6: yaw and pitch of each member");
}

TEST_F(OperatorTest, RefusesMoreJointsThanAChainCanHave) {
  const auto goal = op_->morph(1, std::vector<double>(40, 0.0), 0);
  EXPECT_EQ(progress(goal), GoalProgress::refused);
}

TEST_F(OperatorTest, HoldsAMorphBackWhileTheChainAgrees) {
  FakeModule& m1 = add_module(1);
  m1.announce_agreeing(43, 42);
  const auto goal = op_->morph(1, std::array{0.1, 0.2}, 0);
  run(1);
  EXPECT_TRUE(m1.morphs.empty());
  EXPECT_EQ(progress(goal), GoalProgress::unsent);
  EXPECT_EQ(reason(goal), "its chain is being agreed on");
}

TEST_F(OperatorTest, HearsOfTheFailureOfAnotherMember) {
  FakeModule& m1 = add_module(1);
  FakeModule& m2 = add_module(2);
  m1.announce({1, 2}, 42);
  m2.announce({1, 2}, 42);
  run(0.2);
  const auto goal = op_->go_to(1, {0, 0, 2}, 0, 0);
  run(0.3);
  m1.answer(Kind::flight, goal, Phase::accepted, "", module_now());
  m2.answer(Kind::flight, goal, Phase::accepted, "", module_now());
  run(0.1);
  m2.answer(Kind::flight, goal, Phase::aborted, "estimation lost", module_now());
  run(0.1);
  EXPECT_EQ(progress(goal), GoalProgress::aborted);
  EXPECT_EQ(reason(goal), "module 2: estimation lost");
}

TEST_F(OperatorTest, StampsInTheModulesTimeWhenThatIsSimulated) {
  now_ = TimePoint{1'700'000'000s};
  module_ahead_ = 5s - now_.time_since_epoch();  // the world began five seconds ago
  FakeModule& m1 = add_module(1);
  m1.announce({1}, 0);
  op_->dock(1, 2);
  run(0.2);
  EXPECT_TRUE(op_->fleet().simulated_time());
  ASSERT_EQ(m1.docks.size(), 1u);
  EXPECT_NEAR(1e-9 * static_cast<double>(m1.docks[0].stamp_ns), 5.0, 0.2);
}

TEST_F(OperatorTest, WaitsForTheModulesTimeBeforeItStampsAGoal) {
  FakeModule& m1 = add_module(1);
  m1.announce({1}, 0);  // kept for late listeners, so it may be the first thing heard
  op_->dock(1, 2);
  for (int k = 0; k < 100; ++k) {
    Network::of(domain).advance(now_);
    op_->poll(now_);
    now_ += 10ms;
  }
  EXPECT_NE(op_->fleet().find(1), nullptr);
  EXPECT_FALSE(op_->fleet().time_known());
  run(0.3);
  EXPECT_TRUE(op_->fleet().time_known());
  EXPECT_EQ(m1.docks.size(), 1u);
}

TEST_F(OperatorTest, StampsInItsOwnTimeWhenTheClocksAgreeRoughly) {
  module_ahead_ = 400ms;
  FakeModule& m1 = add_module(1);
  m1.announce({1}, 0);
  op_->undock(1, 2);
  run(0.2);
  ASSERT_EQ(m1.docks.size(), 1u);
  EXPECT_EQ(m1.docks[0].action, msg::DockAction::undock);
  EXPECT_NEAR(1e-9 * static_cast<double>(m1.docks[0].stamp_ns), 100.0, 0.2);
}

TEST_F(OperatorTest, GetsItsGoalsThroughALossyRadio) {
  Network::of(domain).set_default_link({.delay = 10ms, .jitter = 3ms, .loss = 0.4});
  FakeModule& m1 = add_module(1);
  m1.announce({1}, 0);
  std::vector<std::uint64_t> goals;
  for (int k = 0; k < 5; ++k) {
    goals.push_back(op_->arm(1));
    run(1.5);
    ASSERT_FALSE(m1.modes.empty());
    EXPECT_EQ(m1.modes.back().correlation_id, goals.back());
    m1.answer(Kind::mode, goals.back(), Phase::succeeded, "", module_now());
    run(1);
    EXPECT_EQ(progress(goals.back()), GoalProgress::succeeded);
  }
}

TEST_F(OperatorTest, DrawsOtherCorrelationIdsThanTheOperatorBefore) {
  const std::uint64_t one = Operator(*operators_).arm(1);
  EXPECT_NE(one, 0u);
  EXPECT_GT(one, 1'000'000'000u);
}

}  // namespace
}  // namespace eciton::deploy
