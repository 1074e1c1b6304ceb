// What becomes of samples on a link, against the distributions the quality promises.
#include "core/bus/vendors/sim_network/link.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace eciton::bus::sim_network {
namespace {

constexpr int trials = 100'000;

/// Five standard deviations of a binomial share.
double tolerance(double probability) { return 5 * std::sqrt(probability * (1 - probability) / trials); }

TEST(RandomStreamTest, GivesThePublishedSequenceOfSplitMix64) {
  // From the reference implementation by S. Vigna, seed 1234567.
  RandomStream random(1234567);
  for (const std::uint64_t expected : {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                       4593380528125082431u, 16408922859458223821u})
    EXPECT_EQ(random.next(), expected);
}

TEST(RandomStreamTest, IsUniformOnTheUnitInterval) {
  RandomStream random(1);
  double sum = 0, sum_of_squares = 0;
  for (int k = 0; k < trials; ++k) {
    const double u = random.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    sum_of_squares += u * u;
  }
  EXPECT_NEAR(sum / trials, 0.5, 0.005);
  EXPECT_NEAR(sum_of_squares / trials, 1.0 / 3, 0.005);
}

TEST(LinkSeedTest, DependsOnTheSeedAndOnBothNamesInOrder) {
  EXPECT_EQ(link_seed(1, "a", "b"), link_seed(1, "a", "b"));
  EXPECT_NE(link_seed(1, "a", "b"), link_seed(2, "a", "b"));
  EXPECT_NE(link_seed(1, "a", "b"), link_seed(1, "b", "a"));
  EXPECT_NE(link_seed(1, "ab", "c"), link_seed(1, "a", "bc"));
}

TEST(FateTest, ALinkWithoutFaultsDrawsNothing) {
  RandomStream random(5);
  const Fate fate = decide({}, true, random);
  EXPECT_FALSE(fate.lost);
  EXPECT_EQ(fate.delay, Duration::zero());
  EXPECT_EQ(random.next(), RandomStream(5).next());
}

TEST(FateTest, LosesTheConfiguredShare) {
  RandomStream random(11);
  int lost = 0;
  for (int k = 0; k < trials; ++k) lost += decide({.loss = 0.2}, false, random).lost;
  EXPECT_NEAR(static_cast<double>(lost) / trials, 0.2, tolerance(0.2));
  EXPECT_GT(std::abs(static_cast<double>(lost) / trials - 0.21), tolerance(0.2));  // the test can tell 21 % from 20 %
}

TEST(FateTest, JitterIsUniformAroundTheDelay) {
  RandomStream random(12);
  const LinkQuality quality{.delay = 10ms, .jitter = 4ms};
  double sum = 0, sum_of_squares = 0;
  for (int k = 0; k < trials; ++k) {
    const Duration delay = decide(quality, false, random).delay;
    ASSERT_GE(delay, 6ms);
    ASSERT_LE(delay, 14ms);
    sum += to_s(delay - 10ms);
    sum_of_squares += to_s(delay - 10ms) * to_s(delay - 10ms);
  }
  EXPECT_NEAR(sum / trials, 0, 5e-5);
  EXPECT_NEAR(std::sqrt(sum_of_squares / trials), 4e-3 / std::sqrt(3.0), 2e-5);
}

TEST(FateTest, NoDelayIsNegative) {
  RandomStream random(13);
  for (int k = 0; k < 1000; ++k) EXPECT_GE(decide({.delay = 1ms, .jitter = 5ms}, false, random).delay, 0ns);
}

TEST(FateTest, AReliableSampleIsSentAgainUntilItArrives) {
  RandomStream random(14);
  const LinkQuality quality{.delay = 1ms, .jitter = 0ms, .loss = 0.5};
  double attempts = 0;
  for (int k = 0; k < trials; ++k) {
    const Fate fate = decide(quality, true, random);
    ASSERT_FALSE(fate.lost);
    ASSERT_EQ(fate.last_attempt, (fate.attempts - 1) * (2ms + retransmission_period));
    ASSERT_EQ(fate.delay, fate.last_attempt + 1ms);
    attempts += fate.attempts;
  }
  EXPECT_NEAR(attempts / trials, 2.0, 0.03);  // the mean of a geometric distribution
}

TEST(FateTest, AttemptsAreBounded) {
  RandomStream random(15);
  const Fate fate = decide({.loss = 1}, true, random);
  EXPECT_TRUE(fate.lost);
  EXPECT_EQ(fate.attempts, attempts_max);
}

TEST(FateTest, DuplicatesAndHoldsBackTheConfiguredShares) {
  RandomStream random(16);
  int duplicated = 0, held_back = 0;
  for (int k = 0; k < trials; ++k) {
    const Fate fate = decide({.duplication = 0.1, .reordering = 0.05, .hold = 7ms}, false, random);
    duplicated += fate.duplicate.has_value();
    held_back += fate.held_back;
    ASSERT_EQ(fate.delay, fate.held_back ? 7ms : 0ms);
  }
  EXPECT_NEAR(static_cast<double>(duplicated) / trials, 0.1, tolerance(0.1));
  EXPECT_NEAR(static_cast<double>(held_back) / trials, 0.05, tolerance(0.05));
}

TEST(FateTest, AReliableSampleIsNeverHeldBack) {
  RandomStream random(17);
  EXPECT_FALSE(decide({.reordering = 1}, true, random).held_back);
}

}  // namespace
}  // namespace eciton::bus::sim_network
