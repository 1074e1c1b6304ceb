// Against cases computed by hand.
#include "deploy/report/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eciton::report {
namespace {

using Values = std::vector<double>;

TEST(StatisticsTest, MeanAndDeviation) {
  EXPECT_DOUBLE_EQ(mean(Values{1, 2, 6}), 3);
  EXPECT_DOUBLE_EQ(standard_deviation(Values{1, 2, 6}), std::sqrt((4 + 1 + 9) / 3.0));
  EXPECT_EQ(standard_deviation(Values{7}), 0);
  EXPECT_TRUE(std::isnan(mean(Values{})));
}

TEST(StatisticsTest, ABoxHoldsQuartilesAndItsWhiskersLeaveOutliersOut) {
  const Box box = box_of({100, 5, 1, 4, 2, 3});  // ranks 1.25, 2.5 and 3.75 of 1 2 3 4 5 100
  EXPECT_DOUBLE_EQ(box.lower_quartile, 2.25);
  EXPECT_DOUBLE_EQ(box.median, 3.5);
  EXPECT_DOUBLE_EQ(box.upper_quartile, 4.75);
  EXPECT_DOUBLE_EQ(box.whisker_low, 1);
  EXPECT_DOUBLE_EQ(box.whisker_high, 5);  // up to 4.75 + 1.5 * 2.5
  EXPECT_DOUBLE_EQ(box_of({3}).whisker_high, 3);
}

TEST(StatisticsTest, ADensityIsTheMeanOfItsKernels) {
  // One deviation from either value: exp(-1/2) / sqrt(2 pi) = 0.241971.
  EXPECT_NEAR(kernel_density(Values{0, 2}, 1, 1), 0.2419707, 1e-7);
  EXPECT_NEAR(kernel_density(Values{0, 2}, 0.5, 1), 0.5 * 2 * 0.1079819, 1e-7);  // exp(-2) / sqrt(2 pi) / 0.5
  const Values values{1, 2, 3, 4, 5};
  // min(sqrt(2), 2 / 1.34) = 1.414214, times 0.9, times 5^-0.2 = 0.724780
  EXPECT_NEAR(kernel_width(values), 0.922487, 1e-5);
  double sum = 0;
  for (double at = -10; at < 16; at += 0.01) sum += 0.01 * kernel_density(values, kernel_width(values), at);
  EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(StatisticsTest, EqualValuesHaveAWidthToo) {
  EXPECT_GT(kernel_width(Values{0, 0, 0}), 0);
  EXPECT_GT(kernel_width(Values{5, 5}), 0);
}

/// Of a sine after its transient.
double gain(double frequency_Hz, double corner_Hz) {
  constexpr double period_s = 0.001;
  Values sine;
  for (int i = 0; i < 20'000; ++i) sine.push_back(std::sin(2 * std::numbers::pi * frequency_Hz * period_s * i));
  const Values out = low_passed(sine, period_s, corner_Hz);
  double greatest = 0;
  for (std::size_t i = out.size() / 2; i < out.size(); ++i) greatest = std::max(greatest, std::abs(out[i]));
  return greatest;
}

TEST(StatisticsTest, TheLowPassHalvesThePowerAtItsCorner) {
  EXPECT_NEAR(gain(5, 5), 1 / std::numbers::sqrt2, 1e-3);
  EXPECT_NEAR(gain(0.5, 5), 1, 1e-3);
  EXPECT_NEAR(gain(50, 5), 0.01, 1e-3);            // 40 dB a decade
  EXPECT_GT(std::abs(gain(5, 10) - 0.7071), 0.2);  // another corner would have been noticed
}

TEST(StatisticsTest, TheLowPassBeginsWhereTheValuesDo) {
  for (const double value : low_passed(Values(50, 3.0), 0.01, 5)) EXPECT_NEAR(value, 3, 1e-12);
  EXPECT_EQ(low_passed(Values{1, 5, 2}, 0.2, 5), (Values{1, 5, 2}));  // 5 samples a second hold no 5 Hz
  EXPECT_TRUE(low_passed(Values{}, 0.01, 5).empty());
}

TEST(StatisticsTest, ThinningKeepsEverySpike) {
  Values x, y;
  for (int i = 0; i < 10'000; ++i) {
    x.push_back(i);
    y.push_back(i == 5432 ? 9 : i == 1234 ? -9 : 0);
  }
  const auto kept = thinned(x, y, 100);
  EXPECT_LE(kept.size(), 400u);
  EXPECT_EQ(std::count(kept.begin(), kept.end(), 5432u), 1);
  EXPECT_EQ(std::count(kept.begin(), kept.end(), 1234u), 1);
  EXPECT_EQ(kept.back(), 9999u);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(thinned(Values(9000, 1.0), Values(9000, 2.0), 100).back(), 8999u);  // no time goes by
}

}  // namespace
}  // namespace eciton::report
