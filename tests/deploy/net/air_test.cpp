// The radio against cases computed by hand, and its chances against the distributions they promise.
#include "deploy/net/air.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "deploy/net/requests.hpp"

namespace eciton::net {
namespace {

constexpr int trials = 100'000;

/// Five standard deviations of a binomial share.
double tolerance(double probability) { return 5 * std::sqrt(probability * (1 - probability) / trials); }

/// Three hosts; times are counted from zero.
class AirTest : public ::testing::Test {
 protected:
  void set(const std::vector<std::string>& words, const std::string& from = "*", const std::string& to = "*") {
    const Status status = apply(air, from, to, words);
    ASSERT_TRUE(status.ok()) << status.error().message;
  }
  std::string refusal(const std::vector<std::string>& words, const std::string& from = "*",
                      const std::string& to = "*") {
    const Status status = apply(air, from, to, words);
    return status ? "accepted" : status.error().message;
  }
  std::vector<Flight> land_all(Duration until = 1h) {
    std::vector<Flight> flights;
    while (const auto flight = air.land(until)) flights.push_back(*flight);
    return flights;
  }
  std::vector<Duration> dues(const std::vector<Flight>& flights) {
    std::vector<Duration> result;
    for (const Flight& flight : flights) result.push_back(flight.due);
    return result;
  }
  /// Sends many frames from the first host to the second and returns which were lost.
  std::vector<bool> losses(int count = trials) {
    std::vector<bool> lost;
    for (int k = 0; k < count; ++k) {
      lost.push_back(air.send({.from = 0, .to = 1, .bytes = 100}, Duration{k}) == 0);
      land_all();
    }
    return lost;
  }

  Air air{{"a", "b", "c"}, 7};
};

TEST_F(AirTest, WithoutSettingsAFrameArrivesAtOnceAndOnlyWhereItShall) {
  EXPECT_EQ(air.send({.from = 0, .to = 1, .bytes = 60, .slot = 5}, 3ms), 1u);
  const auto flights = land_all(3ms);
  ASSERT_EQ(flights.size(), 1u);
  EXPECT_EQ(flights[0].due, 3ms);
  EXPECT_EQ(flights[0].to, 1u);
  EXPECT_EQ(flights[0].slot, 5u);
  EXPECT_EQ(air.counters(0, 1).delivered, 1u);
  EXPECT_EQ(air.counters(0, 1).bytes, 60u);
  EXPECT_EQ(air.counters(0, 2).sent, 0u);
}

TEST_F(AirTest, AMulticastReachesEveryOtherHost) {
  EXPECT_EQ(air.send({.from = 1, .bytes = 60}, 0ms), 2u);
  std::vector<std::uint32_t> to;
  for (const Flight& flight : land_all(0ms)) to.push_back(flight.to);
  EXPECT_EQ(to, (std::vector<std::uint32_t>{0, 2}));
}

TEST_F(AirTest, ADelayIsOfItsOwnDirection) {
  set({"delay=20ms"}, "a", "b");
  air.send({.from = 0, .to = 1, .bytes = 60}, 1ms);
  air.send({.from = 1, .to = 0, .bytes = 60}, 1ms);
  EXPECT_EQ(air.next_due(), Duration(1ms));
  EXPECT_EQ(dues(land_all()), (std::vector<Duration>{1ms, 21ms}));
}

TEST_F(AirTest, NothingLandsBeforeItIsDue) {
  set({"delay=20ms"});
  air.send({.from = 0, .to = 1, .bytes = 60}, 0ms);
  EXPECT_FALSE(air.land(20ms - 1ns));
  EXPECT_TRUE(air.land(20ms));
  EXPECT_FALSE(air.next_due());
}

TEST_F(AirTest, JitterKeepsTheOrderOfALink) {
  set({"delay=10ms", "jitter=10ms"});
  for (int k = 0; k < 1000; ++k)
    air.send({.from = 0, .to = 1, .bytes = 60, .slot = static_cast<std::uint32_t>(k)}, k * 1ms);
  std::uint32_t expected = 0;
  for (const Flight& flight : land_all()) EXPECT_EQ(flight.slot, expected++);
  EXPECT_EQ(air.counters(0, 1).reordered, 0u);
}

TEST_F(AirTest, AShorterDelaySetLiveDoesNotOvertakeWhatIsInFlight) {
  set({"delay=20ms"});
  air.send({.from = 0, .to = 1, .bytes = 60, .slot = 1}, 0ms);
  set({"delay=5ms"});
  air.send({.from = 0, .to = 1, .bytes = 60, .slot = 2}, 1ms);
  air.send({.from = 0, .to = 1, .bytes = 60, .slot = 3}, 40ms);
  EXPECT_EQ(dues(land_all()), (std::vector<Duration>{20ms, 20ms, 45ms}));
}

TEST_F(AirTest, ReorderedFramesAreHeldBackAndCounted) {
  set({"delay=5ms", "hold=30ms", "reordering=100%"});
  air.send({.from = 0, .to = 1, .bytes = 60, .slot = 1}, 0ms);
  set({"reordering=0"});
  air.send({.from = 0, .to = 1, .bytes = 60, .slot = 2}, 1ms);
  EXPECT_EQ(dues(land_all()), (std::vector<Duration>{6ms, 35ms}));
  EXPECT_EQ(air.counters(0, 1).reordered, 1u);
}

TEST_F(AirTest, DuplicatesArriveTwice) {
  set({"delay=5ms", "duplication=100%"});
  EXPECT_EQ(air.send({.from = 0, .to = 1, .bytes = 60}, 0ms), 2u);
  // The second copy draws a delay of its own, from when the first one is due.
  EXPECT_EQ(dues(land_all()), (std::vector<Duration>{5ms, 10ms}));
  EXPECT_EQ(air.counters(0, 1).duplicated, 1u);
  EXPECT_EQ(air.counters(0, 1).delivered, 2u);
}

TEST_F(AirTest, AllShareOneMediumFrameByFrame) {
  set({"rate=8Mbit/s"});  // 1 byte in 1 us
  air.send({.from = 0, .to = 1, .bytes = 1000}, 0ms);
  air.send({.from = 1, .to = 2, .bytes = 500}, 200us);
  air.send({.from = 2, .to = 0, .bytes = 500}, 5ms);
  EXPECT_EQ(dues(land_all()), (std::vector<Duration>{1000us, 1500us, 5500us}));
}

TEST_F(AirTest, AMulticastTakesTheAirOnce) {
  set({"rate=8Mbit/s"});
  EXPECT_EQ(air.send({.from = 0, .bytes = 1000}, 0ms), 2u);
  EXPECT_EQ(dues(land_all()), (std::vector<Duration>{1ms, 1ms}));
}

TEST_F(AirTest, FramesThatAreLostTakeNoAirtime) {
  set({"rate=8Mbit/s"});
  set({"loss=100%"}, "a", "b");
  set({"cut=on"}, "a", "c");
  EXPECT_EQ(air.send({.from = 0, .bytes = 1000}, 0ms), 0u);
  air.send({.from = 1, .to = 2, .bytes = 1000}, 0ms);
  EXPECT_EQ(dues(land_all()), (std::vector<Duration>{1ms}));
}

TEST_F(AirTest, TheBacklogDropsWhatWouldWaitTooLongAndChargesItNothing) {
  set({"rate=8Mbit/s", "backlog=2ms"});
  int launched = 0;
  for (int k = 0; k < 10; ++k) launched += static_cast<int>(air.send({.from = 0, .to = 1, .bytes = 1000}, 0ms));
  EXPECT_EQ(launched, 3);  // waits of 0, 1 and 2 ms
  EXPECT_EQ(air.counters(0, 1).dropped, 7u);
  EXPECT_EQ(air.send({.from = 0, .to = 1, .bytes = 1000}, 1ms), 1u);
  EXPECT_EQ(dues(land_all()).back(), Duration(4ms));
}

TEST_F(AirTest, ACutIsOfItsOwnDirectionAndAPartitionOfBoth) {
  set({"cut=on"}, "a", "b");
  EXPECT_EQ(air.send({.from = 0, .to = 1, .bytes = 60}, 0ms), 0u);
  EXPECT_EQ(air.send({.from = 1, .to = 0, .bytes = 60}, 0ms), 1u);
  EXPECT_EQ(air.counters(0, 1).lost, 1u);
  set({"clear"});
  set({"partition=a"});  // the others are one more group
  EXPECT_EQ(air.send({.from = 0, .bytes = 60}, 0ms), 0u);
  EXPECT_EQ(air.send({.from = 2, .bytes = 60}, 0ms), 1u);
  set({"partition=none"});
  EXPECT_EQ(air.send({.from = 0, .bytes = 60}, 0ms), 2u);
}

TEST_F(AirTest, WhatIsInFlightArrivesInSpiteOfACut) {
  set({"delay=5ms"});
  air.send({.from = 0, .to = 1, .bytes = 60}, 0ms);
  set({"cut=on"});
  EXPECT_EQ(land_all().size(), 1u);
}

TEST_F(AirTest, FramesWithoutASlotAreDroppedAndFlightsAreBounded) {
  EXPECT_EQ(air.send({.from = 0, .to = 1, .bytes = 60, .slot = Frame::no_slot}, 0ms), 0u);
  EXPECT_EQ(air.counters(0, 1).dropped, 1u);
  set({"delay=1s"});
  for (std::size_t k = 0; k < Air::flights_max + 10; ++k) air.send({.from = 0, .to = 1, .bytes = 60}, 0ms);
  EXPECT_EQ(air.counters(0, 1).dropped, 11u);
  EXPECT_EQ(land_all().size(), Air::flights_max);
}

TEST_F(AirTest, WhatAReceiverRefusesCountsAsDropped) {
  air.send({.from = 0, .to = 1, .bytes = 60}, 0ms);
  air.refuse(*air.land(0ms));
  EXPECT_EQ(air.counters(0, 1).delivered, 0u);
  EXPECT_EQ(air.counters(0, 1).dropped, 1u);
  EXPECT_EQ(air.counters(0, 1).bytes, 0u);
}

TEST_F(AirTest, LosesTheConfiguredShare) {
  set({"loss=20%"});
  losses();
  const double share = static_cast<double>(air.counters(0, 1).lost) / trials;
  EXPECT_NEAR(share, 0.2, tolerance(0.2));
  EXPECT_GT(std::abs(share - 0.21), tolerance(0.2));  // the test can tell 21 % from 20 %
}

/// Gilbert and Elliott: with the chances p to begin and r to end, p/(p+r) of the frames are in bursts, whose lengths
/// are geometric with the mean 1/r; what follows a lost frame is lost with 1-r.
TEST_F(AirTest, BurstsHaveTheShareAndTheLengthOfGilbertAndElliott) {
  set({"burst_start=2%", "burst_end=20%"});
  const std::vector<bool> lost = losses();
  int total = 0, bursts = 0, both = 0;
  for (std::size_t k = 1; k < lost.size(); ++k) {
    total += lost[k];
    bursts += lost[k] && !lost[k - 1];
    both += lost[k] && lost[k - 1];
  }
  const double share = 0.02 / 0.22;
  // Frames of one burst go together: the variance of the share is (2-p-r)/(p+r) times the binomial's.
  const double wider = std::sqrt((2 - 0.22) / 0.22);
  EXPECT_NEAR(static_cast<double>(total) / trials, share, wider * tolerance(share));
  const double length = static_cast<double>(total) / bursts;
  EXPECT_NEAR(length, 5, 5 * std::sqrt(20.0 / bursts));  // variance of the geometric: (1-r)/r^2
  EXPECT_NEAR(static_cast<double>(both) / total, 0.8, 5 * std::sqrt(0.8 * 0.2 / total));
}

/// The control: loss of the same share without bursts fails what the test above asks for.
TEST_F(AirTest, PlainLossHasNoBursts) {
  set({"loss=9.0909%"});
  const std::vector<bool> lost = losses();
  int total = 0, both = 0;
  for (std::size_t k = 1; k < lost.size(); ++k) {
    total += lost[k];
    both += lost[k] && lost[k - 1];
  }
  EXPECT_LT(static_cast<double>(both) / total, 0.12);
}

TEST_F(AirTest, ABurstLosesItsOwnShareAndEndsWhenBurstsAreSwitchedOff) {
  set({"burst_start=100%", "burst_end=0", "burst_loss=30%", "loss=0"});
  losses();
  EXPECT_NEAR(static_cast<double>(air.counters(0, 1).lost) / trials, 0.3, tolerance(0.3));
  const auto before = air.counters(0, 1).lost;
  set({"burst_start=0"});
  losses(1000);
  EXPECT_EQ(air.counters(0, 1).lost, before);
}

TEST_F(AirTest, OneSeedGivesOneRunWhateverTheOtherLinksCarry) {
  Air same({"a", "b", "c"}, 7), other_seed({"a", "b", "c"}, 8);
  for (Air* one : {&air, &same, &other_seed}) ASSERT_TRUE(apply(*one, "*", "*", {"loss=30%"}).ok());
  const std::vector<bool> lost = losses(1000);
  int differing = 0;
  for (int k = 0; k < 1000; ++k) {
    same.send({.from = 2, .bytes = 60}, 0ms);  // beside it
    EXPECT_EQ(same.send({.from = 0, .to = 1, .bytes = 100}, 0ms) == 0, lost[static_cast<std::size_t>(k)]);
    differing += (other_seed.send({.from = 0, .to = 1, .bytes = 100}, 0ms) == 0) != lost[static_cast<std::size_t>(k)];
  }
  EXPECT_GT(differing, 300);  // 420 in the mean
}

TEST_F(AirTest, WrongWordsChangeNothingAndNameWhatWouldBeRight) {
  const auto says = [](const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
  };
  says(refusal({"delay=20ms", "los=10%"}), {"no setting 'los'", "loss", "rate"});
  EXPECT_EQ(air.link(0, 1), LinkSettings{});
  says(refusal({"delay=20"}), {"delay=20: ", "20ms"});
  says(refusal({"loss=120%"}), {"loss=120%: ", "0% to 100%"});
  says(refusal({"loss"}), {"'loss'", "key=value"});
  says(refusal({"cut=1"}), {"cut=1: ", "on or off"});
  says(refusal({"rate=6"}), {"rate=6: ", "6Mbit/s"});
  says(refusal({"rate=6Mbit/s"}, "a"), {"rate is of the medium"});
  says(refusal({"partition=a+x/b"}), {"no host 'x'", "a, b, c"});
  says(refusal({"partition=a/a"}), {"a is in it twice"});
  says(refusal({"delay=1ms"}, "a", "m9"), {"no host 'm9'", "a, b, c"});
  says(refusal({"delay=1ms"}, "a", "a"), {"no link to itself"});
  says(refusal({}), {"nothing to set"});
}

TEST_F(AirTest, AnswersLinesOfText) {
  bool stop = false;
  EXPECT_EQ(answer(air, *set_request("a", "", {"delay=20ms", "loss=10%"}), stop), "ok");
  EXPECT_EQ(differences(air.link(0, 1)), "delay=20ms loss=10%");
  EXPECT_EQ(differences(air.link(0, 2)), "delay=20ms loss=10%");
  EXPECT_EQ(differences(air.link(1, 0)), "");
  EXPECT_NE(answer(air, "show", stop).find("\"changed\":\"delay=20ms loss=10%\""), std::string::npos);
  EXPECT_TRUE(answer(air, "sett * * loss=1", stop).starts_with(error_prefix));
  EXPECT_FALSE(stop);
  EXPECT_EQ(answer(air, "down", stop), "ok");
  EXPECT_TRUE(stop);
  EXPECT_FALSE(set_request("a b", "", {"loss=0"}).ok());
  EXPECT_FALSE(set_request("a", "", {"loss=0\ndown"}).ok());
}

TEST(SettingsTest, WhatIsPrintedReadsBackAsTheSame) {
  for (const Duration value : {Duration(0), Duration(1ns), Duration(20ms), Duration(1500us), Duration(60s)}) {
    Duration back{-1};
    ASSERT_TRUE(from_text(to_text(value), back).ok()) << to_text(value);
    EXPECT_EQ(back, value);
  }
  EXPECT_EQ(to_text(Duration(1500us)), "1500us");
  EXPECT_EQ(to_text(0.1), "10%");
  EXPECT_EQ(to_text(BitRate{6e6}), "6Mbit/s");
  EXPECT_EQ(to_text(BitRate{}), "unlimited");
  Duration half{};
  ASSERT_TRUE(from_text("0.5ms", half).ok());
  EXPECT_EQ(half, 500us);
}

}  // namespace
}  // namespace eciton::net
