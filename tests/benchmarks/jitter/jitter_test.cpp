// Short runs without real-time rights: they end, and their figures hang together. No time is asserted.
#include "benchmarks/jitter/jitter.hpp"

#include <gtest/gtest.h>

#include "benchmarks/jitter/cyclictest.hpp"

namespace eciton::bench {
namespace {

class JitterTest : public testing::Test {
 protected:
  runtime::StopFlag stop_;
  Progress progress_;
  JitterOptions options_{.conditions = {"idle"}, .block_s = 0.3, .rounds = 2, .realtime_priority = 0};
};

TEST_F(JitterTest, MeasuresEveryStepOfTheServiceAndOfTheBaseline) {
  options_.cyclictest = find_tool("cyclictest", "rt-tests").ok();
  const Result result = run_jitter(options_, stop_, progress_);
  ASSERT_FALSE(result.partial) << (result.notes.empty() ? "" : result.notes.back());
  ASSERT_EQ(result.samples.size(), options_.cyclictest ? 2u : 1u);
  for (const Samples& samples : result.samples) {
    EXPECT_GT(samples.values.size(), 20u) << samples.name;
    EXPECT_EQ(samples.values.size(), samples.at_s.size());
    for (const double late_us : samples.values) EXPECT_GE(late_us, 0) << samples.name;
  }
  EXPECT_GE(result.metrics["late_us_p99.ours.idle"], result.metrics["late_us_p50.ours.idle"]);
  if (options_.cyclictest) {
    EXPECT_GT(result.metrics["jitter_ratio_p99.idle"], 0);
  }
}

TEST_F(JitterTest, FliesControlUnderDdsTraffic) {
  options_.conditions = {"traffic"};
  options_.cyclictest = false;
  const Result result = run_jitter(options_, stop_, progress_);
  EXPECT_FALSE(result.partial) << (result.notes.empty() ? "" : result.notes.back());
}

TEST_F(JitterTest, AnUnknownConditionIsBadInputBeforeAnythingStarts) {
  options_.conditions = {"idle", "stormy"};
  try {
    run_jitter(options_, stop_, progress_);
    FAIL();
  } catch (const BadInput& bad) {
    EXPECT_NE(bad.error.message.find("stormy"), std::string::npos);
    EXPECT_NE(bad.error.message.find("idle, loaded or traffic"), std::string::npos);
  }
}

TEST_F(JitterTest, WhatIsInterruptedIsPartialAndEndsAtOnce) {
  stop_.request();
  EXPECT_TRUE(run_jitter(options_, stop_, progress_).partial);
}

}  // namespace
}  // namespace eciton::bench
