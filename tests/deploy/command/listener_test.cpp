// A tool's ear on the simulated network: with a queue a burst is counted whole, without one only its end.
#include "deploy/command/listener.hpp"

#include <gtest/gtest.h>

#include "core/bus/vendors/sim_network/sim_network.hpp"
#include "idl/topics.hpp"

namespace eciton::deploy {
namespace {

using bus::sim_network::Network;

constexpr std::uint32_t domain = 21;
constexpr std::uint32_t burst = 200;

/// How many of a burst of imu samples, of one key, that came before the tool looked.
std::uint64_t heard_of_a_burst(std::uint32_t depth, std::string& account) {
  Network::reset_all();
  Network::of(domain).configure(1, bus::sim_network::Pacing::virtual_time);
  const TopicEntry& imu = find_topic("imu");
  RingOptions ring;
  ring.domain = domain;
  ring.vendor = "sim_network";
  Listener listener(ring, "eciton topic hz", {&imu}, depth);
  bus::Participant module({.vendor = "sim_network", .domain = domain, .name = "m1", .peers = {}});
  auto writer = module.create_writer(topics::imu);
  TimePoint now{1000s};
  for (std::uint32_t k = 0; k < burst; ++k, now += 2ms) {
    writer.write(msg::Imu{.module_id = 1, .stamp_ns = to_ns(now)});
    Network::of(domain).advance(now);
  }
  Network::of(domain).advance(now);
  std::uint64_t heard = 0;
  std::int64_t stamp_before_ns = 0;
  listener.run(
      [&](const Arrival& arrival) {
        const auto sample = imu.decode(arrival.cdr);
        EXPECT_TRUE(sample && sample->stamp_ns > stamp_before_ns) << "in their order";
        stamp_before_ns = sample->stamp_ns;
        return ++heard < burst;
      },
      50ms, 1s, [] {});
  account = listener.account();
  return heard;
}

TEST(ListenerTest, CountsABurstWholeWithAQueue) {
  std::string account;
  EXPECT_EQ(heard_of_a_burst(256, account), burst);
  EXPECT_EQ(account, "received 200, none dropped");
}

// The negative control: as deep as the topic's class, which services want, it hears the last one.
TEST(ListenerTest, HearsOnlyTheLastOfABurstWithout) {
  std::string account;
  EXPECT_EQ(heard_of_a_burst(0, account), 1u);
}

TEST(ListenerTest, LosesTheOldestOverTheQueuesBound) {
  std::string account;
  EXPECT_EQ(heard_of_a_burst(65, account), 65u);
}

}  // namespace
}  // namespace eciton::deploy
