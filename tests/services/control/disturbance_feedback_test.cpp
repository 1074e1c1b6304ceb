// Disturbance feedback: it follows, freezes near contact, decays after.
#include "services/control/disturbance_feedback.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace eciton::control {
namespace {

TEST(DisturbanceFeedbackTest, OpposesTheWrenchWithItsLag) {
  DisturbanceFeedback feedback;
  robot::Wrench ff;
  for (int k = 0; k < 25; ++k) ff = feedback.update({{2, 0, 0}, {0.5, 0, 0}}, FeedbackPhase::follow, 0.002);
  EXPECT_NEAR(ff.force.x(), -2 * (1 - std::exp(-1.0)), 1e-12);  // 20 1/s for 0.05 s
  EXPECT_NEAR(ff.moment.x(), -0.5 * (1 - std::exp(-1.0)), 1e-12);
}

TEST(DisturbanceFeedbackTest, FreezesThenDecays) {
  DisturbanceFeedback feedback;
  for (int k = 0; k < 1000; ++k) feedback.update({{2, 0, 0}, {}}, FeedbackPhase::follow, 0.002);
  const robot::Wrench frozen = feedback.update({{-30, 0, 0}, {}}, FeedbackPhase::freeze, 0.002);
  EXPECT_NEAR(frozen.force.x(), -2, 1e-9);
  robot::Wrench ff;
  for (int k = 0; k < 500; ++k) ff = feedback.update({{-30, 0, 0}, {}}, FeedbackPhase::decay, 0.002);
  EXPECT_NEAR(ff.force.x(), -2 * std::exp(-1), 1e-9);
}

TEST(DisturbanceFeedbackTest, OneWildEstimateIsLimited) {
  DisturbanceFeedback feedback;
  for (int k = 0; k < 1000; ++k) feedback.update({{500, 0, 0}, {}}, FeedbackPhase::follow, 0.002);
  EXPECT_NEAR(feedback.feed_forward_W().force.x(), -12, 1e-6);
}

TEST(DisturbanceFeedbackTest, PhaseFollowsTheCommandedGap) {
  EXPECT_EQ(feedback_phase(false, 0, false), FeedbackPhase::follow);
  EXPECT_EQ(feedback_phase(true, 0.06, false), FeedbackPhase::follow);
  EXPECT_EQ(feedback_phase(true, 0.04, false), FeedbackPhase::freeze);
  EXPECT_EQ(feedback_phase(true, -0.1, true), FeedbackPhase::decay);
}

}  // namespace
}  // namespace eciton::control
