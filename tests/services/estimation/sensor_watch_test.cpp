// What is refused of an IMU and a pose source, and how spells of refusals are told of.
#include "services/estimation/sensor_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace eciton::estimation {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

ImuSample imu_at(int k, double x = 0) { return {k * 2'000'000ll, {x, 0, 9.81}, Vector3::Zero()}; }
RawPose pose_at(int k, double x = 0) { return {k * 10'000'000ll, {x, 0, 1}, {1, 0, 0, 0}, 0.001, 0.003}; }

TEST(ImuCheckTest, RefusesWhatNoSensorSays) {
  ImuCheck check;
  EXPECT_EQ(check.check(imu_at(1), 2'000'000), Refusal::none);
  EXPECT_EQ(check.check(imu_at(2, no_number), 4'000'000), Refusal::not_finite);
  EXPECT_EQ(check.check(imu_at(2, 1e6), 4'000'000), Refusal::out_of_range);
  ImuSample spinning = imu_at(2);
  spinning.w_WB_B_rad_s = {0, 0, 100};
  EXPECT_EQ(check.check(spinning, 4'000'000), Refusal::out_of_range);
  EXPECT_EQ(check.check(imu_at(500, 0.1), 4'000'000), Refusal::stamp_ahead);
  EXPECT_EQ(check.check(imu_at(2, 0.1), 4'000'000), Refusal::none);
}

TEST(ImuCheckTest, TenEqualSamplesAreAFrozenSensorNineAreNot) {
  ImuCheck check;
  for (int k = 1; k <= 9; ++k) EXPECT_EQ(check.check(imu_at(k), k * 2'000'000ll), Refusal::none) << k;
  EXPECT_EQ(check.check(imu_at(10), 20'000'000), Refusal::frozen);
  EXPECT_EQ(check.check(imu_at(11), 22'000'000), Refusal::frozen);
  EXPECT_EQ(check.check(imu_at(12, 1e-3), 24'000'000), Refusal::none) << "it lives again";
  ImuCheck lenient({.frozen_samples = 0});
  for (int k = 1; k <= 99; ++k) EXPECT_EQ(lenient.check(imu_at(k), k * 2'000'000ll), Refusal::none);
}

TEST(PoseCheckTest, RefusesWhatIsNoPose) {
  PoseCheck check;
  EXPECT_EQ(check.check(pose_at(1)), Refusal::none);
  EXPECT_EQ(check.check(pose_at(2, no_number)), Refusal::not_finite);
  EXPECT_EQ(check.check(pose_at(2, 1e9)), Refusal::out_of_range);
  for (const double deviation : {0.0, -0.01, no_number, std::numeric_limits<double>::infinity()}) {
    RawPose pose = pose_at(2, 0.1);
    pose.position_std_m = deviation;
    EXPECT_EQ(check.check(pose), Refusal::bad_deviation) << deviation;
    pose = pose_at(2, 0.1);
    pose.attitude_std_rad = deviation;
    EXPECT_EQ(check.check(pose), Refusal::bad_deviation) << deviation;
  }
  RawPose turned = pose_at(2, 0.1);
  turned.q_WB = {0, 0, 0, 0};
  EXPECT_EQ(check.check(turned), Refusal::not_normalised);
  turned.q_WB = {0.9, 0.9, 0, 0};
  EXPECT_EQ(check.check(turned), Refusal::not_normalised);
  turned.q_WB = {0, 0, no_number, 1};
  EXPECT_EQ(check.check(turned), Refusal::not_finite);
  EXPECT_EQ(check.check(pose_at(2, 0.1)), Refusal::none);
}

TEST(PoseCheckTest, ThreeEqualPosesAreAFrozenSource) {
  PoseCheck check;
  EXPECT_EQ(check.check(pose_at(1)), Refusal::none);
  EXPECT_EQ(check.check(pose_at(2)), Refusal::none);
  EXPECT_EQ(check.check(pose_at(3)), Refusal::frozen);
  EXPECT_EQ(check.check(pose_at(4, 1e-6)), Refusal::none);
}

TEST(PoseCheckTest, StampsGoForwardUnlessTheClockWasSetBack) {
  PoseCheck check;
  int value = 0;
  const auto at = [&](int k) { return check.check(pose_at(k, ++value)); };
  EXPECT_EQ(at(100), Refusal::none);
  EXPECT_EQ(at(100), Refusal::stamp_repeated);
  for (int k = 99; k > 50; --k)
    EXPECT_EQ(at(k), Refusal::stamp_backward) << "running backward, it never gets through";
  EXPECT_EQ(at(101), Refusal::none);
  for (int k = 1; k < 8; ++k) EXPECT_EQ(at(k), Refusal::stamp_backward);
  EXPECT_EQ(at(8), Refusal::none) << "eight in order: another clock";
  EXPECT_EQ(at(9), Refusal::none);
}

TEST(RefusalSpellTest, IsToldOfOnceWhenItBeginsAndOnceWhenItIsOver) {
  RefusalSpell spell;
  int told = 0, over = 0;
  SpellReport last;
  const auto ms = [](int k) { return k * 1'000'000ll; };
  for (int k = 0; k < 5000; k += 10) {
    if (k >= 1000 && k < 3000) spell.refuse(k < 1100 ? Refusal::not_finite : Refusal::frozen, ms(k));
    const auto report = spell.report(ms(k));
    if (!report) continue;
    (report->over ? over : told)++;
    last = *report;
    if (!report->over) {
      EXPECT_EQ(k, 1050);
      EXPECT_EQ(report->cause, Refusal::not_finite);
      EXPECT_EQ(report->refused, 6U);
    }
  }
  EXPECT_EQ(told, 1);
  EXPECT_EQ(over, 1);
  EXPECT_EQ(last.refused, 200U);
  EXPECT_EQ(last.cause, Refusal::frozen) << "the most frequent one";
  EXPECT_NEAR(last.lasted_s, 1.99, 1e-9);
  EXPECT_EQ(spell.refused(), 200U);
}

TEST(RefusalSpellTest, AFewPosesBeyondTheGateAreCountedButNoFault) {
  RefusalSpell spell;
  for (int k = 0; k < 4; ++k) spell.refuse(Refusal::implausible, k * 1'000'000ll);
  for (int k = 0; k < 3000; ++k) EXPECT_FALSE(spell.report(k * 1'000'000ll));
  EXPECT_EQ(spell.refused(), 4U);
}

TEST(RefusalSpellTest, ASingleSampleThatIsNoNumberIsAFault) {
  RefusalSpell spell;
  spell.refuse(Refusal::not_finite, 0);
  int reports = 0;
  for (int k = 0; k < 3000; ++k) reports += spell.report(k * 1'000'000ll).has_value();
  EXPECT_EQ(reports, 2);
}

TEST(RefusalSpellTest, SilenceIsASpellThatRefusesNothing) {
  RefusalSpell spell;
  std::optional<SpellReport> report;
  for (int k = 0; k < 100 && !report; ++k) {
    spell.silent(k * 5'000'000ll);
    report = spell.report(k * 5'000'000ll);
  }
  ASSERT_TRUE(report);
  EXPECT_EQ(report->cause, Refusal::silent);
  EXPECT_EQ(spell.refused(), 0U);
}

}  // namespace
}  // namespace eciton::estimation
