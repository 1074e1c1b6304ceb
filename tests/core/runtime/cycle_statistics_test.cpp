// Statistics of cycles against cases computed by hand, and quantiles against a sorted list.
#include "core/runtime/cycle_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace eciton::runtime {
namespace {

/// Starts at 0, 2, 4, 7, 9 ms: periods 2, 2, 3, 2; jitter 0, 1, 1 ms. Execution 100 to 500 µs.
CycleStatistics five_cycles(Duration from) {
  CycleStatistics statistics;
  Duration execution = 100us;
  for (const Duration start : {0ms, 2ms, 4ms, 7ms, 9ms}) {
    statistics.record(from + start, execution);
    execution += 100us;
  }
  return statistics;
}

TEST(CycleStatisticsTest, MatchesACaseComputedByHand) {
  const CycleStatistics statistics = five_cycles(100s);
  const auto recent = statistics.recent(100s + 10ms);
  EXPECT_EQ(recent.cycles, 5u);
  EXPECT_EQ(recent.period_mean, 2250us);
  EXPECT_NEAR(to_s(recent.jitter_p99), 1e-3, 0.032e-3);
  EXPECT_EQ(recent.execution_mean, 300us);
  EXPECT_EQ(recent.execution_max, 500us);
  EXPECT_EQ(statistics.period_mean(), 2250us);
  EXPECT_EQ(statistics.execution_mean(), 300us);
  EXPECT_EQ(statistics.execution().max, 500us);
  EXPECT_EQ(statistics.jitter().max, 1ms);
}

TEST(CycleStatisticsTest, ForgetsWhatIsOlderThanASecondButNotTheWholeRun) {
  CycleStatistics statistics = five_cycles(100s);
  EXPECT_EQ(statistics.recent(103s).cycles, 0u);
  EXPECT_EQ(statistics.recent(103s).period_mean, 103s - (100s + 9ms))
      << "a service that stopped must not look regular";
  for (int k = 0; k < 10; ++k) statistics.record(103s + k * 10ms, 50us);
  const auto recent = statistics.recent(103s + 100ms);
  EXPECT_EQ(recent.cycles, 10u);
  EXPECT_EQ(recent.execution_max, 50us);
  EXPECT_EQ(statistics.execution().max, 500us);
  EXPECT_EQ(statistics.cycles(), 15u);
}

TEST(CycleStatisticsTest, SlidesOverALongRun) {
  CycleStatistics statistics;
  for (int k = 0; k < 5000; ++k) statistics.record(k * 2ms, 1us * (k % 7));
  const auto recent = statistics.recent(5000 * 2ms);
  EXPECT_GE(recent.cycles, 450u);
  EXPECT_LE(recent.cycles, 500u);
  EXPECT_EQ(recent.period_mean, 2ms);
  EXPECT_EQ(recent.jitter_p99, Duration::zero());
}

TEST(CycleStatisticsTest, WithoutCyclesSaysZero) {
  const CycleStatistics statistics;
  const auto recent = statistics.recent(5s);
  EXPECT_EQ(recent.cycles, 0u);
  EXPECT_EQ(recent.period_mean, Duration::zero());
  EXPECT_EQ(recent.jitter_p99, Duration::zero());
  EXPECT_EQ(statistics.execution().p99, Duration::zero());
}

TEST(CycleStatisticsTest, FillsAHeartbeat) {
  CycleStatistics statistics = five_cycles(0s);
  statistics.count_overruns(3);
  msg::Heartbeat heartbeat;
  statistics.fill(heartbeat, 10ms);
  EXPECT_EQ(heartbeat.cycles, 5u);
  EXPECT_EQ(heartbeat.overruns, 3u);
  EXPECT_DOUBLE_EQ(heartbeat.period_s, 2.25e-3);
  EXPECT_NEAR(heartbeat.jitter_s_p99, 1e-3, 0.032e-3);
  EXPECT_DOUBLE_EQ(heartbeat.execution_s_mean, 300e-6);
  EXPECT_DOUBLE_EQ(heartbeat.execution_s_max, 500e-6);
}

TEST(CycleStatisticsTest, PrintsALineAsWideAsItsHeading) {
  const std::string line = five_cycles(0s).table_line("estimation");
  EXPECT_NE(line.find("estimation"), std::string::npos);
  EXPECT_NE(line.find("2250.0"), std::string::npos);
  EXPECT_EQ(line.size(), CycleStatistics::table_heading().size());
}

TEST(DurationHistogramTest, QuantilesAreWithinABinOfASortedList) {
  std::mt19937 random(7);
  std::lognormal_distribution<double> seconds(std::log(50e-6), 1.5);
  DurationHistogram<std::uint64_t> histogram;
  std::vector<double> sorted;
  for (int k = 0; k < 20000; ++k) {
    const Duration d = from_s(seconds(random));
    histogram.add(d);
    sorted.push_back(to_s(d));
  }
  std::sort(sorted.begin(), sorted.end());
  for (const double fraction : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const double exact = sorted[static_cast<std::size_t>(std::ceil(fraction * 20000)) - 1];
    EXPECT_NEAR(to_s(histogram.quantile(fraction)), exact, 0.033 * exact) << fraction;
  }
}

TEST(DurationHistogramTest, HoldsTheShortestAndTheLongest) {
  DurationHistogram<std::uint16_t> histogram;
  histogram.add(-5ns);
  histogram.add(0ns);
  histogram.add(15ns);
  histogram.add(std::chrono::hours(10));
  EXPECT_EQ(histogram.total(), 4u);
  EXPECT_EQ(histogram.quantile(0.5), 0ns);
  EXPECT_EQ(histogram.quantile(0.75), 15ns);
  EXPECT_GT(histogram.quantile(1.0), 60s);
  for (int k = 0; k < 70000; ++k) histogram.add(100ns);
  EXPECT_EQ(histogram.total(), 4u + 65535u) << "a full bin stays full";
}

}  // namespace
}  // namespace eciton::runtime
