// The target holds still, engages, follows the follower's word, and lets go of one it has lost.
#include "services/docking/target_sequence.hpp"

#include <gtest/gtest.h>

namespace eciton::docking {
namespace {

class TargetSequenceTest : public testing::Test {
 protected:
  TargetSequenceTest() {
    in.follower_fresh = true;
    in.follower_phase = DockingPhase::align;
    target.accept();
  }
  const TargetOutputs& step(double seconds = 0.01) {
    for (int k = 0; k < seconds / 0.01; ++k) target.update(0.01, in);
    return target.outputs();
  }
  TargetInputs in;
  TargetSequence target{TargetConfig{}};
};

TEST_F(TargetSequenceTest, HoldsStillAndEngagesForTheApproach) {
  EXPECT_TRUE(step().hold_still);
  EXPECT_FALSE(step().engage_latch);
  in.follower_phase = DockingPhase::approach;
  EXPECT_TRUE(step().engage_latch);
  in.follower_phase = DockingPhase::recover;
  EXPECT_FALSE(step().engage_latch);
  EXPECT_TRUE(step().hold_still);
}

TEST_F(TargetSequenceTest, IsDockedWhenLatchedAndOfOneView) {
  in.follower_phase = DockingPhase::approach;
  step();
  in.latch = LatchStatus::latched;
  EXPECT_EQ(step().phase, DockingPhase::assembly);
  in.view_active = true;
  EXPECT_EQ(step().phase, DockingPhase::docked);
  EXPECT_TRUE(step().engage_latch);
  EXPECT_FALSE(step().hold_still);
}

TEST_F(TargetSequenceTest, GivesUpAFollowerLostMidApproach) {
  in.follower_phase = DockingPhase::approach;
  step();
  in.follower_fresh = false;
  EXPECT_EQ(step(0.9).phase, DockingPhase::approach);
  EXPECT_EQ(step(0.2).phase, DockingPhase::idle);
  EXPECT_EQ(step().failure, Failure::target_silent);
  EXPECT_FALSE(step().engage_latch);
  EXPECT_FALSE(step().hold_still);
}

TEST_F(TargetSequenceTest, KeepsALatchedFollowerThatFellSilent) {
  in.follower_phase = DockingPhase::assembly;
  in.latch = LatchStatus::latched;
  in.view_active = true;
  step();
  in.follower_fresh = false;
  EXPECT_EQ(step(60).phase, DockingPhase::docked);
  EXPECT_TRUE(step().engage_latch);
}

TEST_F(TargetSequenceTest, LetsGoWhenTheFollowerReleases) {
  in.latch = LatchStatus::latched;
  in.view_active = true;
  step(0.05);
  in.follower_phase = DockingPhase::release;
  EXPECT_EQ(step().phase, DockingPhase::release);
  EXPECT_FALSE(step().engage_latch);
  in.latch = LatchStatus::open;
  EXPECT_EQ(step().phase, DockingPhase::idle);
  EXPECT_EQ(step().failure, Failure::none);
}

TEST_F(TargetSequenceTest, LetsGoForAnUndockingItHearsOfInIdle) {
  TargetSequence fresh{TargetConfig{}};
  in.latch = LatchStatus::latched;
  in.view_active = true;
  in.follower_phase = DockingPhase::release;
  fresh.accept();
  fresh.update(0.01, in);
  fresh.update(0.01, in);
  EXPECT_FALSE(fresh.outputs().engage_latch);
  EXPECT_EQ(fresh.outputs().phase, DockingPhase::release);
}

TEST_F(TargetSequenceTest, LetsGoWhenNoViewComesOfIt) {
  in.latch = LatchStatus::latched;
  EXPECT_EQ(step(9.9).phase, DockingPhase::assembly);
  EXPECT_EQ(step(0.2).phase, DockingPhase::release);
  in.latch = LatchStatus::open;
  EXPECT_EQ(step().failure, Failure::no_view);
}

TEST_F(TargetSequenceTest, ReportsALatchThatDoesNotOpen) {
  in.latch = LatchStatus::latched;
  in.view_active = true;
  step(0.05);
  in.follower_phase = DockingPhase::release;
  EXPECT_EQ(step(5.2).failure, Failure::latch_stuck);
}

TEST_F(TargetSequenceTest, EndsWhenTheFollowerDoes) {
  in.follower_phase = DockingPhase::retreat;
  EXPECT_EQ(step().phase, DockingPhase::retreat);
  EXPECT_FALSE(step().engage_latch);
  in.follower_phase = DockingPhase::idle;
  EXPECT_EQ(step().phase, DockingPhase::idle);
}

}  // namespace
}  // namespace eciton::docking
