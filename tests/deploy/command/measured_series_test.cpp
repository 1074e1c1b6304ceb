// Statistics against figures worked out by hand.
#include "deploy/command/measured_series.hpp"

#include <gtest/gtest.h>

namespace eciton::deploy {
namespace {

TEST(MeasuredSeriesTest, AgreesWithAHandComputedCase) {
  MeasuredSeries series;
  for (const double value : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) series.add(value);
  EXPECT_EQ(series.count(), 8U);
  EXPECT_DOUBLE_EQ(series.mean(), 5);
  EXPECT_DOUBLE_EQ(series.standard_deviation(), std::sqrt(32.0 / 7));
  EXPECT_EQ(series.min(), 2);
  EXPECT_EQ(series.max(), 9);
  EXPECT_EQ(series.quantile(0.5), 4);   // rank 4 of 8
  EXPECT_EQ(series.quantile(0.75), 5);  // rank 6
  EXPECT_EQ(series.quantile(0.99), 9);
  EXPECT_EQ(series.quantile(0), 2);
}

TEST(MeasuredSeriesTest, KeepsExactExtremesBeyondItsMemory) {
  MeasuredSeries series(10);
  series.add(-1);
  for (int k = 0; k < 100; ++k) series.add(k % 5);
  EXPECT_EQ(series.count(), 101U);
  EXPECT_EQ(series.min(), -1);
  EXPECT_NEAR(series.mean(), 199.0 / 101, 1e-12);
  EXPECT_GE(series.quantile(0), 0);  // of the last ten only
}

TEST(MeasuredSeriesTest, HasNoSpreadWithOneValue) {
  MeasuredSeries series;
  series.add(3);
  EXPECT_EQ(series.standard_deviation(), 0);
  EXPECT_EQ(series.quantile(0.99), 3);
}

}  // namespace
}  // namespace eciton::deploy
