// The intervals on distributions whose truth is known: how often they hold it, and that they would not if
// samples were taken for independent.
#include "benchmarks/statistics/bootstrap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "benchmarks/statistics/summary.hpp"

namespace eciton::bench {
namespace {

/// Latencies whose blocks each have a weather of their own, as on a machine that others use too.
class Weather {
 public:
  explicit Weather(std::uint64_t seed) : random_(seed) {}

  /// Log-normal around `median`; the blocks' own factors are shared with `twin`, measured beside it.
  std::pair<Blocks, Blocks> pair(double median, double twin_median, std::size_t count, std::size_t size) {
    Blocks blocks(count), twins(count);
    for (std::size_t b = 0; b < count; ++b) {
      const double weather = std::exp(0.2 * normal());
      for (std::size_t i = 0; i < size; ++i) {
        blocks[b].push_back(median * weather * std::exp(0.1 * normal()));
        twins[b].push_back(twin_median * weather * std::exp(0.1 * normal()));
      }
    }
    return {blocks, twins};
  }

 private:
  double normal() {
    const double u = (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53;
    const double v = (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53;
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
  }
  std::mt19937_64 random_;
};

bool holds(const Interval& interval, double truth) { return interval.low <= truth && truth <= interval.high; }

constexpr int trials = 200;

/// 95 % wanted; 200 trials tell 90 from 98.5.
void expect_about_95_percent(int held) {
  EXPECT_GE(held, trials * 90 / 100);
  EXPECT_LE(held, trials * 985 / 1000);
}

TEST(BootstrapTest, TheMediansIntervalHoldsTheTruthAsOftenAsItSays) {
  for (const std::size_t blocks : {6u, 16u}) {
    int held = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const Blocks measured = Weather(static_cast<std::uint64_t>(trial)).pair(100, 1, blocks, 25).first;
      held += holds(median_interval(measured, 1), 100);
    }
    expect_about_95_percent(held);
  }
}

TEST(BootstrapTest, SamplesTakenForIndependentWouldPromiseTooMuch) {
  int held = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Blocks singles;
    for (const std::vector<double>& block : Weather(static_cast<std::uint64_t>(trial)).pair(100, 1, 8, 20).first) {
      for (const double value : block) singles.push_back({value});
    }
    held += holds(median_interval(singles, 1), 100);
  }
  EXPECT_LT(held, 40 * 60 / 100);
}

TEST(BootstrapTest, TheRatiosIntervalHoldsTheTruthAsOftenAsItSays) {
  int held = 0;
  double width = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const auto [ours, theirs] = Weather(static_cast<std::uint64_t>(trial)).pair(105, 100, 10, 25);
    const Interval ratio = ratio_interval(ours, theirs, 0.5, 1);
    held += holds(ratio, 1.05);
    width += (ratio.high - ratio.low) / trials;
  }
  EXPECT_GE(held, trials * 90 / 100);
  EXPECT_LT(width, 0.12);  // cautious rather than bold, but not useless
}

TEST(BootstrapTest, WhatDisturbsBothOfAPairCancels) {
  auto [ours, theirs] = Weather(3).pair(105, 100, 20, 50);
  const Interval paired = ratio_interval(ours, theirs, 0.5, 1);
  std::rotate(theirs.begin(), theirs.begin() + 7, theirs.end());  // neighbours no more
  const Interval strangers = ratio_interval(ours, theirs, 0.5, 1);
  EXPECT_EQ(paired.value, strangers.value);
  EXPECT_LT(2 * (paired.high - paired.low), strangers.high - strangers.low);
  theirs.pop_back();
  EXPECT_GT(ratio_interval(ours, theirs, 0.5, 1).high, paired.high);  // drawn apart: no pairs to be had
}

TEST(BootstrapTest, ThreeBlocksGiveTheWorstAndBestThatCanBeDrawn) {
  const Interval median = median_interval({{1, 1, 4}, {2}, {9, 3}}, 5);
  EXPECT_EQ(median.value, 2);  // 1 1 2 3 4 9: rank 3
  EXPECT_EQ(median.low, 1);    // the first block thrice
  EXPECT_EQ(median.high, 3);   // the last block thrice: 3 3 3 9 9 9
  const Interval ratio = ratio_interval({{2}, {6}}, {{1}, {2}}, 0.5, 5);
  EXPECT_EQ(ratio.value, 2);
  EXPECT_EQ(ratio.low, 2);
  EXPECT_EQ(ratio.high, 3);
}

TEST(BootstrapTest, TheSeedDecidesEveryBit) {
  const Blocks blocks = Weather(1).pair(100, 1, 12, 30).first;
  const Interval a = median_interval(blocks, 1), b = median_interval(blocks, 1), c = median_interval(blocks, 2);
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
  EXPECT_TRUE(a.low != c.low || a.high != c.high);
}

TEST(BootstrapTest, OneBlockSaysNothingAboutItsConfidenceAndNoneNothingAtAll) {
  const Interval one = median_interval({{1, 2, 3}, {}}, 1);
  EXPECT_EQ(one.value, 2);
  EXPECT_TRUE(std::isinf(one.low) && std::isinf(one.high));
  EXPECT_TRUE(std::isnan(median_interval({}, 1).value));
  EXPECT_TRUE(std::isnan(ratio_interval({{1}}, {}, 0.5, 1).value));
  // The partner of an empty block goes with it.
  EXPECT_EQ(ratio_interval({{2}, {100}}, {{1}, {}}, 0.5, 1).value, 2);
}

TEST(BootstrapTest, ALongRunStaysQuick) {
  const auto [ours, theirs] = Weather(1).pair(105, 100, 20, 5000);
  EXPECT_LT(ratio_interval(ours, theirs, 0.99, 1).high, 1.2);
}

TEST(BlocksTest, ARunIsCutIntoNeighbours) {
  EXPECT_EQ(cut({1, 2, 3, 4, 5}, 2), (Blocks{{1, 2}, {3, 4, 5}}));
  EXPECT_EQ(cut({1, 2}, 5), (Blocks{{1}, {2}}));
  EXPECT_EQ(cut({}, 5), Blocks{});
}

TEST(BlocksTest, ALinearDriftFallsOnAllVariantsAlike) {
  EXPECT_EQ(abba_order(2, 2), (std::vector<std::size_t>{0, 1, 1, 0}));
  for (const std::size_t variants : {2u, 3u, 5u}) {
    const std::vector<std::size_t> order = abba_order(variants, 4);
    std::vector<std::size_t> places(variants);
    for (std::size_t place = 0; place < order.size(); ++place) places[order[place]] += place;
    for (const std::size_t sum : places) EXPECT_EQ(sum, places[0]);
  }
}

}  // namespace
}  // namespace eciton::bench
