// Rates held on the average, per key, and what is dropped is counted.
#include "services/radio/rate_limit.hpp"

#include <gtest/gtest.h>

namespace eciton::radio {
namespace {

constexpr TimePoint t0{1000s};

int passed(RateLimit& limit, Duration every, Duration span, std::uint64_t key = 1) {
  int count = 0;
  for (Duration t{}; t < span; t += every) count += limit.allow(t0 + t, key);
  return count;
}

TEST(RateLimitTest, ThinsOutToTheInterval) {
  RateLimit limit(20ms);
  EXPECT_NEAR(passed(limit, 2ms, 10s), 500, 2);
  EXPECT_NEAR(static_cast<double>(limit.dropped()), 4500, 2);
}

TEST(RateLimitTest, HoldsTheMeanWhenPeriodsDoNotDivide) {
  RateLimit limit(20ms);
  EXPECT_NEAR(passed(limit, 3ms, 10s), 500, 5);
}

TEST(RateLimitTest, LetsTheOwnRatePassWithItsJitter) {
  RateLimit limit(10ms);
  int count = 0;
  for (int k = 0; k < 1000; ++k) count += limit.allow(t0 + k * 10ms + (k % 2 == 0 ? 500us : -500us), 1);
  EXPECT_EQ(count, 1000);
}

TEST(RateLimitTest, DoesNotSaveUpSilenceForABurst) {
  RateLimit limit(10ms);
  EXPECT_TRUE(limit.allow(t0, 1));
  int burst = 0;
  for (int k = 0; k < 10; ++k) burst += limit.allow(t0 + 60s, 1);
  EXPECT_LE(burst, 2);
}

TEST(RateLimitTest, KeepsKeysApart) {
  RateLimit limit(1s);
  EXPECT_TRUE(limit.allow(t0, 1));
  EXPECT_TRUE(limit.allow(t0, 2));
  EXPECT_FALSE(limit.allow(t0 + 1ms, 1));
}

TEST(RateLimitTest, ForgetsTheKeyUnusedForLongest) {
  RateLimit limit(1s);
  for (std::uint64_t key = 0; key <= RateLimit::keys_max; ++key) {
    EXPECT_TRUE(limit.allow(t0 + key * 1ms, key));
  }
  EXPECT_FALSE(limit.allow(t0 + 100ms, 1)) << "key 0 was the one forgotten";
  EXPECT_TRUE(limit.allow(t0 + 100ms, 0));
}

TEST(RateLimitTest, SurvivesAClockSetBack) {
  RateLimit limit(10ms);
  EXPECT_TRUE(limit.allow(t0, 1));
  EXPECT_TRUE(limit.allow(t0 - 1h, 1));
}

TEST(RateLimitTest, LetsEverythingPassWithoutAnInterval) {
  RateLimit limit(Duration::zero());
  EXPECT_EQ(passed(limit, 1ms, 1s), 1000);
}

}  // namespace
}  // namespace eciton::radio
