// Order statistics and jitter against values counted by hand.
#include "benchmarks/statistics/summary.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace eciton::bench {
namespace {

std::vector<double> shuffled_1_to(std::size_t n) {
  std::vector<double> values(n);
  std::iota(values.begin(), values.end(), 1);
  std::shuffle(values.begin(), values.end(), std::mt19937(7));
  return values;
}

TEST(SummaryTest, QuantilesAreOrderStatistics) {
  EXPECT_EQ(quantile({5, 1, 4, 2, 3}, 0.5), 3);
  EXPECT_EQ(quantile({4, 1, 3, 2}, 0.5), 2);  // a value that was measured, not a mean of two
  EXPECT_EQ(quantile({5, 1, 4, 2, 3}, 0), 1);
  EXPECT_EQ(quantile({5, 1, 4, 2, 3}, 1), 5);
  EXPECT_EQ(quantile({7}, 0.9999), 7);
}

TEST(SummaryTest, RanksAreExactWhereTheFractionIsNotABinaryNumber) {
  const std::vector<double> values = shuffled_1_to(10'000);
  for (const double permyriad : {1., 100., 2'900., 5'000., 9'000., 9'900., 9'990., 9'999.}) {
    EXPECT_EQ(quantile(values, permyriad / 10'000), permyriad);
  }
  EXPECT_EQ(quantile(values, 0.99991), 10'000);
}

TEST(SummaryTest, SummarizesAKnownSequence) {
  Samples samples;
  samples.values = {10, 12, 9, 9, 30};
  const Summary s = summarize(samples);
  EXPECT_EQ(s.count, 5u);
  EXPECT_DOUBLE_EQ(s.mean, 14);
  EXPECT_EQ(s.p50, 10);
  EXPECT_EQ(s.p90, 30);
  EXPECT_EQ(s.max, 30);
  EXPECT_DOUBLE_EQ(s.jitter_mean, (2 + 3 + 0 + 21) / 4.0);
  EXPECT_EQ(s.jitter_p99, 21);
}

TEST(SummaryTest, TheTailOfTenThousandIsTheRightSample) {
  Samples samples;
  samples.values = shuffled_1_to(10'000);
  const Summary s = summarize(samples);
  EXPECT_EQ(s.p50, 5'000);
  EXPECT_EQ(s.p90, 9'000);
  EXPECT_EQ(s.p99, 9'900);
  EXPECT_EQ(s.p999, 9'990);
  EXPECT_EQ(s.p9999, 9'999);
  EXPECT_EQ(s.max, 10'000);
}

TEST(SummaryTest, NothingMeasuredIsNotZero) {
  const Summary s = summarize({});
  EXPECT_EQ(s.count, 0u);
  EXPECT_TRUE(std::isnan(s.mean) && std::isnan(s.p50) && std::isnan(s.max) && std::isnan(s.jitter_p99));
  Samples one;
  one.values = {3};
  EXPECT_EQ(summarize(one).p9999, 3);
  EXPECT_TRUE(std::isnan(summarize(one).jitter_mean));
}

TEST(SummaryTest, AQuantileIsResolvedByOneValueBeyondIt) {
  EXPECT_TRUE(resolves(10'000, 0.9999));
  EXPECT_FALSE(resolves(9'999, 0.9999));
  EXPECT_TRUE(resolves(100, 0.99));
  EXPECT_FALSE(resolves(99, 0.99));
}

}  // namespace
}  // namespace eciton::bench
