// Shares of the medium, counted by hand.
#include "services/radio/airtime.hpp"

#include <gtest/gtest.h>

namespace eciton::radio {
namespace {

constexpr TimePoint t0{1000s};

TEST(AirtimeTest, CountsPayloadAndOverheadAgainstTheBudget) {
  Airtime airtime({.budget_bit_s = 1e6, .overhead_bytes = 50});
  for (int k = 0; k < 100; ++k) airtime.add(t0 + k * 10ms, 200);  // 100 x 250 bytes = 200 kbit in a second
  EXPECT_DOUBLE_EQ(airtime.share(t0 + 990ms), 0.2);
}

TEST(AirtimeTest, ForgetsWhatLeftTheWindow) {
  Airtime airtime({.budget_bit_s = 1e6, .overhead_bytes = 0});
  airtime.add(t0, 12500);  // 100 kbit
  airtime.add(t0 + 500ms, 12500);
  EXPECT_DOUBLE_EQ(airtime.share(t0 + 900ms), 0.2);
  EXPECT_DOUBLE_EQ(airtime.share(t0 + 1200ms), 0.1);
  EXPECT_DOUBLE_EQ(airtime.share(t0 + 1600ms), 0.0);
  airtime.add(t0 + 1h, 12500);
  EXPECT_DOUBLE_EQ(airtime.share(t0 + 1h), 0.1);
}

TEST(AirtimeTest, SaysWhenTheBudgetIsExceeded) {
  Airtime airtime({.budget_bit_s = 1e5, .overhead_bytes = 0});
  airtime.add(t0, 25000);
  EXPECT_DOUBLE_EQ(airtime.share(t0), 2.0);
}

TEST(AirtimeTest, SurvivesAClockSetBack) {
  Airtime airtime({.budget_bit_s = 1e6, .overhead_bytes = 0});
  airtime.add(t0, 12500);
  airtime.add(t0 - 1h, 12500);
  EXPECT_DOUBLE_EQ(airtime.share(t0 - 1h), 0.1);
}

}  // namespace
}  // namespace eciton::radio
