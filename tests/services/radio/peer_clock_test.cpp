// Offsets by hand, the bound against a world that knows the truth, and clocks that jump.
#include "services/radio/peer_clock.hpp"

#include <gtest/gtest.h>

#include <random>

namespace eciton::radio {
namespace {

constexpr TimePoint t0{1000s};

TEST(PeerClockTest, KnowsNothingBeforeAnEcho) {
  PeerClock clock;
  clock.hear(t0, t0 + 5s);
  EXPECT_FALSE(clock.offset(t0));
  EXPECT_FALSE(clock.age(t0, t0));
  EXPECT_EQ(clock.last_heard(), t0);
}

TEST(PeerClockTest, TakesTheOffsetAndHalfTheRoundTrip) {
  // The peer is 7 s ahead; 10 ms there, 500 ms at the peer, 10 ms back.
  PeerClock clock({.drift = 0});
  clock.echo(t0 + 520ms, t0 + 510ms + 7s, t0, t0 + 10ms + 7s);
  const auto offset = clock.offset(t0 + 520ms);
  ASSERT_TRUE(offset);
  EXPECT_EQ(offset->offset, 7s);
  EXPECT_EQ(offset->bound, 10ms);
  EXPECT_EQ(*clock.age(t0 + 600ms, t0 + 550ms + 7s), 50ms);
  EXPECT_EQ(*clock.age(t0 + 600ms, t0 + 700ms + 7s), 0ns) << "never negative";
}

TEST(PeerClockTest, IsOffByHalfTheDifferenceOfLopsidedWaysWithinItsBound) {
  // No true offset; 2 ms there, 30 ms back.
  PeerClock clock({.drift = 0});
  clock.echo(t0 + 132ms, t0 + 102ms, t0, t0 + 2ms);
  const auto offset = clock.offset(t0 + 132ms);
  EXPECT_EQ(offset->offset, -14ms);
  EXPECT_EQ(offset->bound, 16ms);
}

TEST(PeerClockTest, KeepsTheLeastRoundTripOfItsWindow) {
  PeerClock clock({.drift = 0});
  clock.echo(t0 + 4ms, t0 + 2ms, t0, t0 + 2ms);                             // 2 ms
  clock.echo(t0 + 1s + 80ms, t0 + 1s + 40ms, t0 + 1s, t0 + 1s + 40ms);      // 40 ms
  clock.echo(t0 + 20s + 80ms, t0 + 20s + 40ms, t0 + 20s, t0 + 20s + 40ms);  // 40 ms, another slot
  EXPECT_EQ(clock.offset(t0 + 30s)->bound, 2ms);
  EXPECT_EQ(clock.offset(t0 + 70s)->bound, 40ms) << "the good one is too old";
  EXPECT_FALSE(clock.offset(t0 + 90s));
}

TEST(PeerClockTest, WidensTheBoundAsTheClocksMayDrift) {
  PeerClock clock({.drift = 50e-6});
  clock.echo(t0 + 4ms, t0 + 2ms, t0, t0 + 2ms);
  const Duration at_once = clock.offset(t0 + 4ms)->bound;
  EXPECT_NEAR(to_s(clock.offset(t0 + 4ms + 20s)->bound - at_once), 20 * 50e-6, 1e-9);
}

TEST(PeerClockTest, RejectsWhatNoClocksCouldHaveMade) {
  PeerClock clock;
  clock.echo(t0, t0, t0 + 1s, t0);                  // an echo of what we have not sent yet
  clock.echo(t0 + 10s, t0 + 1s, t0, t0 + 1s);       // a round trip of 10 s
  clock.echo(t0 + 1s, t0 + 100ms, t0, t0 + 200ms);  // sent before it was received
  EXPECT_EQ(clock.rejected(), 3u);
  EXPECT_FALSE(clock.offset(t0));
}

TEST(PeerClockTest, ForgetsWhatItKnewWhenTheClockJumps) {
  PeerClock clock;
  clock.echo(t0 + 4ms, t0 + 2ms, t0, t0 + 2ms);
  const TimePoint later = t0 + 10s;
  clock.echo(later + 40ms, later + 20ms + 3s, later, later + 20ms + 3s);
  EXPECT_EQ(clock.steps(), 1u);
  EXPECT_EQ(clock.offset(later + 40ms)->offset, 3s);
  EXPECT_GE(clock.offset(later + 40ms)->bound, 20ms);
}

TEST(PeerClockTest, BoundsTheTruthUnderJitterDriftAndLoss) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    std::mt19937_64 random(seed);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const double drift = 80e-6 * (uniform() - 0.5);
    const Duration offset = from_s(10 * (uniform() - 0.5));
    const auto peer_time = [&](TimePoint t) { return t + offset + from_s(drift * to_s(t - t0)); };
    PeerClock clock;
    Duration worst{};
    for (TimePoint t = t0; t < t0 + 100s; t += 500ms) {
      if (uniform() < 0.3) continue;
      const TimePoint received = t + from_s(0.001 + 0.02 * uniform() * uniform());
      const TimePoint sent = received + from_s(0.5 * uniform());
      const TimePoint back = sent + from_s(0.001 + 0.02 * uniform() * uniform());
      clock.echo(back, peer_time(sent), t, peer_time(received));
      const auto known = clock.offset(back);
      ASSERT_TRUE(known) << seed;
      const Duration error = std::chrono::abs(known->offset - (peer_time(back) - back));
      ASSERT_LE(error, known->bound) << seed;
      worst = std::max(worst, known->bound);
    }
    EXPECT_EQ(clock.steps(), 0u) << seed;
    EXPECT_LT(clock.offset(t0 + 100s)->bound, 4ms) << seed << ": far above the least round trip of 2 ms";
  }
}

TEST(PeerClockTest, WouldBreakItsBoundIfItIgnoredTheDrift) {
  PeerClock clock({.drift = 0});
  clock.echo(t0 + 4ms, t0 + 2ms, t0, t0 + 2ms);
  const double drift = 80e-6;
  const Duration truth = from_s(drift * 50);  // after 50 s
  EXPECT_GT(truth - clock.offset(t0 + 50s)->offset, clock.offset(t0 + 50s)->bound);
}

}  // namespace
}  // namespace eciton::radio
