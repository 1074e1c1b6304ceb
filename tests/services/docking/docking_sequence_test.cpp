// The follower's sequence, phase by phase, with inputs given by hand.
#include "services/docking/docking_sequence.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/allocation_guard/allocation_guard.hpp"

namespace eciton::docking {
namespace {

constexpr double dt_s = 0.01;

/// A follower that stands where its reference is, unless a test says otherwise.
class DockingSequenceTest : public ::testing::TestWithParam<PortKind> {
 protected:
  DockingSequenceTest() { in.target_fresh = true; }

  Pose at(double gap_m, double y_m = 0, double z_m = 0) const {
    return {gap_m * outward_T(port) + Vector3(0, y_m, z_m), robot::Matrix3::Identity()};
  }
  void start(double gap_m = 1.0) {
    in.X_TF = at(gap_m);
    sequence.start_docking(port, in.X_TF);
  }
  const DockingOutputs& step() {
    const DockingOutputs& out = sequence.update(dt_s, in);
    if (following) in.X_TF = out.X_TF_reference;
    return out;
  }
  /// Until the phase is reached; fails after 40 s.
  void run_to(DockingPhase phase) {
    for (int k = 0; k < 4000 && sequence.outputs().phase != phase; ++k) step();
    ASSERT_EQ(sequence.outputs().phase, phase);
  }
  void run_for(double seconds) {
    for (int k = 0; k < seconds / dt_s; ++k) step();
  }

  PortKind port = GetParam();
  DockingInputs in;
  bool following = true;
  DockingSequence sequence{DockingConfig{}};
};

INSTANTIATE_TEST_SUITE_P(BothPorts, DockingSequenceTest, ::testing::Values(PortKind::male, PortKind::female),
                         [](const auto& p) { return p.param == PortKind::male ? "Male" : "Female"; });

TEST_P(DockingSequenceTest, DocksByPoseStepByStep) {
  start();
  EXPECT_FALSE(step().engage_latch);
  run_to(DockingPhase::approach);
  EXPECT_NEAR(sequence.outputs().measured.gap_m, 0.30, 0.01);
  EXPECT_TRUE(step().engage_latch);
  // The ramp: 0.3 m/s towards the port.
  EXPECT_NEAR(step().v_TF_reference.dot(outward_T(port)), -0.3, 1e-9);
  run_to(DockingPhase::assembly);
  EXPECT_EQ(sequence.outputs().declared_by, DeclaredBy::pose);
  EXPECT_NEAR(sequence.outputs().measured.gap_m, 0.0125, 0.0035);
  in.latch = LatchStatus::latched;
  run_for(1);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::assembly) << "latched, but not yet of one view";
  EXPECT_NEAR(sequence.outputs().gap_m_commanded, 0, 1e-9);
  in.view_active = true;
  step();
  EXPECT_EQ(sequence.outputs().outcome, Outcome::docked);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::docked);
  EXPECT_TRUE(sequence.outputs().engage_latch);
  EXPECT_EQ(sequence.outputs().recoveries, 0u);
}

TEST_P(DockingSequenceTest, HoldsTheAlignmentBeforeItApproaches) {
  start(0.30);
  run_for(0.25);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::align);
  following = false;
  in.X_TF = at(0.30, 0.03);  // out of tolerance once: the hold begins anew
  step();
  in.X_TF = at(0.30);
  run_for(0.25);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::align);
  run_for(0.1);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::approach);
}

TEST_P(DockingSequenceTest, KeepsToEachAlignTolerance) {
  following = false;
  const Pose turned{at(0.30).p, robot::exp_so3(Vector3(0, 0, 0.07))};
  for (const Pose& off : {at(0.33), at(0.27), at(0.30, 0.02, 0.02), turned}) {
    in.X_TF = at(0.30);
    start(0.30);
    in.X_TF = off;
    run_for(3);
    EXPECT_EQ(sequence.outputs().phase, DockingPhase::align);
  }
}

TEST_P(DockingSequenceTest, DeclaresByThePushOnlyNearTheEndOfTheRamp) {
  start(0.30);
  run_to(DockingPhase::approach);
  following = false;
  in.X_TF = at(0.05, 0.02);
  in.push_N = 3.5;
  while (sequence.outputs().gap_m_commanded >= 0.15 + 0.3 * dt_s) {
    step();
    ASSERT_EQ(sequence.outputs().phase, DockingPhase::approach);
  }
  run_for(3 * dt_s);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::assembly);
  EXPECT_EQ(sequence.outputs().declared_by, DeclaredBy::wrench);
}

TEST_P(DockingSequenceTest, DoesNotTakeAPullForAPush) {
  start(0.30);
  run_to(DockingPhase::approach);
  following = false;
  in.X_TF = at(0.05);
  in.push_N = -10;
  run_for(1.5);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::approach);
}

TEST_P(DockingSequenceTest, PushesOnUntilTheLatchReports) {
  start(0.30);
  run_to(DockingPhase::assembly);
  following = false;
  run_for(0.9);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::assembly);
  EXPECT_NEAR(sequence.outputs().gap_m_commanded, -0.10, 1e-9);
  in.latch = LatchStatus::latched;
  run_for(0.6);
  EXPECT_NEAR(sequence.outputs().gap_m_commanded, 0, 1e-9);
  EXPECT_EQ(sequence.outputs().false_declarations, 0u);
}

TEST_P(DockingSequenceTest, CountsAFalseDeclarationAndTriesAgain) {
  start(0.30);
  run_to(DockingPhase::assembly);
  run_for(1.1);
  EXPECT_EQ(sequence.outputs().false_declarations, 1u);
  EXPECT_EQ(sequence.outputs().recoveries, 1u);
  EXPECT_EQ(sequence.outputs().declared_by, DeclaredBy::nothing);
  EXPECT_FALSE(sequence.outputs().engage_latch);
  run_to(DockingPhase::align);
  run_to(DockingPhase::assembly);
  in.latch = LatchStatus::latched;
  in.view_active = true;
  step();
  EXPECT_EQ(sequence.outputs().outcome, Outcome::docked);
}

TEST_P(DockingSequenceTest, RecoversWhenBlownOffTheAxis) {
  start(0.30);
  run_to(DockingPhase::approach);
  run_for(0.3);
  following = false;
  in.X_TF = at(0.15, 0.04, 0.04);
  step();
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::recover);
  EXPECT_EQ(sequence.outputs().recoveries, 1u);
  EXPECT_GT(step().v_TF_reference.dot(outward_T(port)), 0);
  following = true;
  run_to(DockingPhase::align);
  EXPECT_NEAR(sequence.outputs().gap_m_commanded, 0.30, 1e-9);
  run_to(DockingPhase::approach);
}

TEST_P(DockingSequenceTest, RecoversWhenPushingComesToNothing) {
  start(0.30);
  run_to(DockingPhase::approach);
  following = false;
  in.X_TF = at(0.03);  // neither near enough nor pushed
  run_for(0.4 / 0.3 + 2.0 + 0.1);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::recover);
}

TEST_P(DockingSequenceTest, GivesUpAfterTooManyRecoveries) {
  start(0.30);
  for (int k = 0; k < 60000 && sequence.outputs().outcome == Outcome::running; ++k) step();
  EXPECT_EQ(sequence.outputs().failure, Failure::too_many_recoveries);
  EXPECT_EQ(sequence.outputs().recoveries, DockingConfig{}.recoveries_max);
  EXPECT_NEAR(relation(in.X_TF, port).gap_m, 0.5, 1e-9);
}

TEST_P(DockingSequenceTest, TakesTheLatchsWordWithoutADeclaration) {
  start(0.30);
  run_to(DockingPhase::approach);
  in.latch = LatchStatus::latched;
  step();
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::assembly);
  EXPECT_EQ(sequence.outputs().declared_by, DeclaredBy::nothing);
}

TEST_P(DockingSequenceTest, RetreatsWhenTheTargetIsLostMidApproach) {
  start(0.30);
  run_to(DockingPhase::approach);
  run_for(0.5);
  in.target_fresh = false;
  const DockingOutputs& out = step();
  EXPECT_EQ(out.phase, DockingPhase::retreat);
  EXPECT_FALSE(out.engage_latch);
  EXPECT_LT(step().v_TF_reference.dot(outward_T(port)), 0.05) << "from rest";
  run_for(0.5);
  EXPECT_NEAR(step().v_TF_reference.dot(outward_T(port)), 0.2, 1e-9);
  run_for(3);
  EXPECT_EQ(sequence.outputs().outcome, Outcome::failed);
  EXPECT_EQ(sequence.outputs().failure, Failure::target_silent);
  EXPECT_NEAR(relation(in.X_TF, port).gap_m, 0.5, 1e-9);
}

TEST_P(DockingSequenceTest, StopsWhereItIsWhenAbortedOnTheWay) {
  start(2.0);
  run_for(0.5);
  in.abort = true;
  EXPECT_EQ(step().outcome, Outcome::failed);
  EXPECT_EQ(sequence.outputs().failure, Failure::aborted);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::idle);
}

TEST_P(DockingSequenceTest, DoesNotTearItselfAwayFromAClosedLatch) {
  start(0.30);
  run_to(DockingPhase::assembly);
  in.latch = LatchStatus::latched;
  in.target_fresh = false;
  in.abort = true;
  run_for(1);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::assembly);
}

TEST_P(DockingSequenceTest, LetsGoWhenNoViewComesOfIt) {
  start(0.30);
  run_to(DockingPhase::assembly);
  in.latch = in.target_latch = LatchStatus::latched;
  run_to(DockingPhase::release);
  EXPECT_FALSE(sequence.outputs().engage_latch);
  in.latch = in.target_latch = LatchStatus::open;
  run_to(DockingPhase::idle);
  EXPECT_EQ(sequence.outputs().failure, Failure::no_view);
}

TEST_P(DockingSequenceTest, DoesNotAlignForEver) {
  start(0.5);
  following = false;
  in.X_TF = at(0.6, 0.5);
  run_for(31);
  EXPECT_EQ(sequence.outputs().failure, Failure::align_time_out);
}

TEST_P(DockingSequenceTest, UndocksOnceBothLatchesAndTheViewLetGo) {
  in.latch = in.target_latch = LatchStatus::latched;
  in.view_active = true;
  in.X_TF = at(0);
  sequence.start_undocking(port, in.X_TF);
  EXPECT_FALSE(step().engage_latch);
  in.latch = LatchStatus::open;
  run_for(0.5);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::release);
  in.target_latch = LatchStatus::open;
  run_for(0.5);
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::release);
  in.view_active = false;
  step();
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::retreat);
  run_for(0.5 / 0.2 + 0.5 * 0.2 / 0.5 + 0.05);  // the way at full speed, and half of the time to get to it
  EXPECT_EQ(sequence.outputs().outcome, Outcome::undocked);
  EXPECT_NEAR(relation(in.X_TF, port).gap_m, 0.5, 1e-9);
}

TEST_P(DockingSequenceTest, ReportsALatchThatDoesNotOpen) {
  in.latch = in.target_latch = LatchStatus::latched;
  in.X_TF = at(0);
  sequence.start_undocking(port, in.X_TF);
  run_for(5.1);
  EXPECT_EQ(sequence.outputs().outcome, Outcome::failed);
  EXPECT_EQ(sequence.outputs().failure, Failure::latch_stuck);
}

TEST_P(DockingSequenceTest, StandsStillWhileNoTimePasses) {
  start(1.0);
  run_for(0.5);
  const Vector3 p = sequence.outputs().X_TF_reference.p;
  const DockingOutputs& out = sequence.update(0, in);
  EXPECT_EQ(out.X_TF_reference.p, p);
  EXPECT_EQ(out.v_TF_reference, Vector3(Vector3::Zero()));
}

TEST_P(DockingSequenceTest, SaysHowFastAChainsReferenceMovesAndTurns) {
  // Sampled at the middle of each step, against the poses on its two sides.
  const std::array<Vector3, 1> mates{1.2 * outward_T(port)};
  in.X_TF = {at(2.5, 0.5).p, robot::exp_so3(Vector3(0, 0.1, 0.5))};
  sequence.start_docking(port, in.X_TF, mates);
  Pose before = in.X_TF;
  double turned_rad = 0;
  for (int k = 0; k < 4000 && sequence.outputs().phase == DockingPhase::align; ++k) {
    const DockingOutputs& out = step();
    const Pose& now = out.X_TF_reference;
    ASSERT_LT((out.v_TF_reference - (now.p - before.p) / dt_s).norm(), 1e-6);
    const Vector3 turn = robot::log_so3(now.R * before.R.transpose());
    // But for the last bit of a turn, which is done at once.
    if (turn.norm() > 1e-3) {
      ASSERT_LT((out.w_TF_reference - turn / dt_s).norm(), 1e-3);
    }
    turned_rad += turn.norm();
    before = now;
  }
  EXPECT_EQ(sequence.outputs().phase, DockingPhase::approach);
  EXPECT_NEAR(turned_rad, Vector3(0, 0.1, 0.5).norm(), 1e-3);
}

TEST_P(DockingSequenceTest, LeavesTheHeapAlone) {
  if (!eciton::testing::AllocationGuard::available()) GTEST_SKIP() << "the sanitizers bring a heap of their own";
  const std::array bodies{Vector3(-3, 0, 0), Vector3(3, 0, 0)};
  in.bodies_T = bodies;
  eciton::testing::AllocationGuard guard;
  start(2.0);
  run_for(10);
  EXPECT_EQ(guard.framework(), 0u) << guard.describe();
}

}  // namespace
}  // namespace eciton::docking
