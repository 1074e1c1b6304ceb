// Loss, jitter, duplication, reordering and partitions, and that one seed gives one network, to the bit.
#include <algorithm>
#include <numeric>

#include "tests/core/bus/sim_network/endpoints.hpp"

namespace eciton::bus::sim_network::testing {
namespace {

using Numbers = std::vector<std::uint32_t>;

constexpr LinkQuality bad_link{
    .delay = 5ms, .jitter = 3ms, .loss = 0.2, .duplication = 0.05, .reordering = 0.05, .hold = 8ms};

Numbers counting(std::uint32_t from, std::uint32_t to) {
  Numbers numbers(to - from);
  std::iota(numbers.begin(), numbers.end(), from);
  return numbers;
}

struct Arrival {
  Duration at;
  std::uint32_t number;
  bool operator==(const Arrival&) const = default;
};

/// Two seconds of traffic on a bad network: what arrived when, at two readers.
std::vector<Arrival> run(std::uint64_t seed, const LinkQuality& quality) {
  Network& network = Network::of(domain);
  network.configure(seed, Pacing::virtual_time);
  network.set_default_link(quality);
  std::vector<Arrival> arrivals;
  {
    TestParticipant a("a"), b("b"), c("c");
    TestWriter fast(a, plain_type(), best_effort_deep, "sensor"), sure(a, plain_type(), reliable_deep, "event");
    TestReader sensor_b(b, plain_type(), best_effort_deep, {}, "sensor");
    TestReader sensor_c(c, plain_type(), best_effort_deep, {}, "sensor");
    TestReader event_b(b, plain_type(), reliable_deep, {}, "event");
    for (std::uint32_t tick = 0; tick < 1000; ++tick) {
      const Duration now = tick * 2ms;
      network.advance(TimePoint{now});
      fast.write(tick);
      if (tick % 10 == 0) sure.write(tick);
      for (TestReader* reader : {&sensor_b, &sensor_c, &event_b})
        for (const std::uint32_t number : reader->take()) arrivals.push_back({now, number});
    }
  }
  Network::reset_all();
  return arrivals;
}

TEST(SimNetworkDeterminismTest, OneSeedGivesOneNetwork) {
  const auto first = run(42, bad_link);
  EXPECT_GT(first.size(), 1500u);
  EXPECT_EQ(first, run(42, bad_link));
  EXPECT_NE(first, run(43, bad_link));
}

TEST(SimNetworkDeterminismTest, LinksDoNotDisturbEachOther) {
  // What b hears from a does not depend on whether c is there.
  const auto heard_by_b = [](bool with_c) {
    Network& network = Network::of(domain);
    network.configure(42, Pacing::virtual_time);
    network.set_default_link(bad_link);
    Numbers heard;
    {
      TestParticipant a("a"), c("c"), b("b");
      TestWriter writer(a, plain_type(), best_effort_deep);
      std::vector<TestReader> others;
      if (with_c) others.emplace_back(c, plain_type(), best_effort_deep);
      TestReader reader(b, plain_type(), best_effort_deep);
      for (std::uint32_t k = 0; k < 500; ++k) {
        network.advance(TimePoint{k * 2ms});
        writer.write(k);
      }
      network.advance(TimePoint{10s});
      heard = reader.take();
    }
    Network::reset_all();
    return heard;
  };
  EXPECT_EQ(heard_by_b(false), heard_by_b(true));
}

TEST_F(VirtualNetwork, BestEffortLosesTheConfiguredShareAndCountsIt) {
  network().set_default_link({.loss = 0.2});
  TestParticipant a("a"), b("b");
  TestWriter writer(a, plain_type(), best_effort_deep);
  TestReader reader(b, plain_type(), best_effort_deep);
  for (std::uint32_t k = 0; k < 4000; ++k) writer.write(k);
  const Statistics count = network().statistics("a", "b");
  EXPECT_EQ(count.sent, 4000u);
  EXPECT_NEAR(static_cast<double>(count.lost) / 4000, 0.2, 0.03);
  EXPECT_EQ(count.delivered, 4000u - count.lost);
  EXPECT_EQ(reader.losses().lost, count.lost);
  const Numbers got = reader.take();
  EXPECT_EQ(got.size(), count.delivered);
  EXPECT_TRUE(std::is_sorted(got.begin(), got.end()));
  EXPECT_EQ(network().statistics("b", "a"), Statistics{});
}

TEST_F(VirtualNetwork, JitterAloneKeepsTheOrderOfAWriter) {
  network().set_default_link({.delay = 20ms, .jitter = 20ms});
  TestParticipant a("a"), b("b");
  TestWriter writer(a, plain_type(), best_effort_deep);
  TestReader reader(b, plain_type(), best_effort_deep);
  for (std::uint32_t k = 0; k < 400; ++k) {
    advance(k * 1ms);
    writer.write(k);
  }
  advance(10s);
  EXPECT_EQ(reader.take(), counting(0, 400));
  EXPECT_EQ(network().statistics().reordered, 0u);
}

TEST_F(VirtualNetwork, AHeldBackSampleIsOvertaken) {
  TestParticipant a("a"), b("b");
  TestWriter writer(a, plain_type(), best_effort_deep);
  TestReader reader(b, plain_type(), best_effort_deep);
  network().set_link("a", "b", {.reordering = 1, .hold = 5ms});
  writer.write(1);
  network().set_link("a", "b", {});
  writer.write(2);
  advance(5ms);
  writer.write(3);
  EXPECT_EQ(reader.take(), (Numbers{2, 1, 3}));
  EXPECT_EQ(network().statistics().reordered, 1u);
}

TEST_F(VirtualNetwork, ALateSampleDoesNotPushOutANewerOne) {
  TestParticipant a("a"), b("b");
  TestWriter writer(a, keyed_type(), best_effort);
  TestReader reader(b, keyed_type(), best_effort);
  network().set_link("a", "b", {.reordering = 1, .hold = 5ms});
  writer.write(1);
  network().set_link("a", "b", {});
  writer.write(2);
  advance(5ms);
  EXPECT_EQ(reader.take(), Numbers{2});
}

TEST_F(VirtualNetwork, DuplicatesReachBestEffortReadersOnly) {
  network().set_default_link({.duplication = 1});
  TestParticipant a("a"), b("b");
  TestWriter fast(a, plain_type(), best_effort_deep, "sensor"), sure(a, plain_type(), reliable_deep, "event");
  TestReader sensor(b, plain_type(), best_effort_deep, {}, "sensor");
  TestReader event(b, plain_type(), reliable_deep, {}, "event");
  fast.write(1);
  sure.write(2);
  EXPECT_EQ(sensor.take(), (Numbers{1, 1}));
  EXPECT_EQ(event.take(), Numbers{2});
  EXPECT_EQ(network().statistics().duplicated, 2u);
}

TEST_F(VirtualNetwork, ReliableDeliversEverySampleOnceInOrderOverLoss) {
  network().set_default_link({.delay = 4ms, .jitter = 3ms, .loss = 0.4, .duplication = 0.2, .reordering = 0.2});
  TestParticipant a("a"), b("b");
  TestWriter writer(a, plain_type(), reliable_deep);
  TestReader reader(b, plain_type(), reliable_deep);
  for (std::uint32_t k = 0; k < 500; ++k) {
    advance(k * 10ms);
    writer.write(k);
  }
  advance(100s);
  EXPECT_EQ(reader.take(), counting(0, 500));
  const Statistics count = network().statistics();
  EXPECT_NEAR(static_cast<double>(count.retransmitted) / 500, 0.4 / 0.6, 0.2);
  EXPECT_EQ(count.lost, 0u);
}

TEST_F(VirtualNetwork, ASampleReplacedInTheHistoryIsNotSentAgain) {
  // Keep last 1 over a lossy link: the newest always arrives, some of those before it never do.
  TestParticipant a("a"), b("b");
  TestWriter writer(a, keyed_type(), reliable);
  TestReader reader(b, keyed_type(), reliable);
  network().set_default_link({.delay = 1ms, .loss = 0.5});
  std::uint32_t newest = 0;
  for (std::uint32_t k = 1; k <= 200; ++k) {
    advance(k * 5ms);
    writer.write(k);
    for (const std::uint32_t number : reader.take()) {
      EXPECT_GT(number, newest);
      newest = number;
    }
  }
  advance(100s);
  EXPECT_EQ(reader.take(), Numbers{200});
  const Statistics count = network().statistics();
  EXPECT_GT(count.superseded, 20u);
  EXPECT_EQ(count.delivered + count.superseded, 200u);
}

TEST_F(VirtualNetwork, APartitionLosesBestEffortAndHoldsReliableSamplesUntilHealed) {
  TestParticipant a("a"), b("b"), c("c");
  TestWriter sensor(a, keyed_type(), best_effort, "sensor"), state(a, keyed_type(), reliable, "state");
  TestReader sensor_b(b, keyed_type(), best_effort, {}, "sensor"), state_b(b, keyed_type(), reliable, {}, "state");
  TestReader sensor_c(c, keyed_type(), best_effort, {}, "sensor");
  network().partition({{"a", "c"}, {"b"}});
  for (std::uint32_t k = 1; k <= 3; ++k) {
    sensor.write(k);
    state.write(10 + k, 1);
    state.write(20 + k, 2);
  }
  EXPECT_EQ(sensor_b.take(), Numbers{});
  EXPECT_EQ(state_b.take(), Numbers{});
  EXPECT_EQ(sensor_c.take(), Numbers{3});
  EXPECT_EQ(network().statistics("a", "b").lost, 3u);
  EXPECT_EQ(sensor_b.losses().lost, 3u);
  network().heal();
  EXPECT_EQ(sensor_b.take(), Numbers{});
  EXPECT_EQ(state_b.take(), (Numbers{13, 23}));
  sensor.write(4);
  EXPECT_EQ(sensor_b.take(), Numbers{4});
}

TEST_F(VirtualNetwork, APartitionCutsOffWhatIsInFlight) {
  network().set_default_link({.delay = 10ms});
  TestParticipant a("a"), b("b");
  TestWriter sensor(a, plain_type(), best_effort_deep, "sensor"), event(a, plain_type(), reliable_deep, "event");
  TestReader sensor_b(b, plain_type(), best_effort_deep, {}, "sensor");
  TestReader event_b(b, plain_type(), reliable_deep, {}, "event");
  for (std::uint32_t k = 0; k < 4; ++k) {
    advance(k * 6ms);
    sensor.write(k);
    event.write(k);
  }
  network().partition({{"a"}});  // at 18 ms: 0 and 1 have arrived
  advance(50ms);
  EXPECT_EQ(sensor_b.take(), (Numbers{0, 1}));
  EXPECT_EQ(event_b.take(), (Numbers{0, 1}));
  network().partition({{"a"}, {"b"}});  // still apart
  network().heal();
  event.write(4);
  advance(60ms);
  EXPECT_EQ(sensor_b.take(), Numbers{});
  EXPECT_EQ(event_b.take(), (Numbers{2, 3, 4}));
}

TEST_F(VirtualNetwork, ALateJoinerBeyondAPartitionGetsTheHistoryWhenHealed) {
  network().partition({{"b"}});
  TestParticipant a("a"), b("b");
  TestWriter writer(a, keyed_type(), transient_local);
  writer.write(1);
  TestReader joiner(b, keyed_type(), transient_local);
  EXPECT_EQ(joiner.take(), Numbers{});
  network().heal();
  EXPECT_EQ(joiner.take(), Numbers{1});
}

TEST_F(VirtualNetwork, AParticipantThatReturnsIsMatchedAgain) {
  TestParticipant b("b");
  TestReader reader(b, keyed_type(), transient_local);
  for (std::uint32_t life = 1; life <= 3; ++life) {
    TestParticipant a("a");
    TestWriter writer(a, keyed_type(), transient_local);
    writer.write(life);
    EXPECT_EQ(reader.matched(), 1u);
    EXPECT_EQ(reader.take(), Numbers{life});
  }
  EXPECT_EQ(reader.matched(), 0u);
}

}  // namespace
}  // namespace eciton::bus::sim_network::testing
