// A real net of two module hosts, measured with UDP: the radio does what was asked for, live, and to nobody else.
#include "deploy/net/net.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "deploy/net/requests.hpp"
#include "tests/deploy/net/udp.hpp"

namespace eciton::net {
namespace {

const std::filesystem::path programs = ECITON_PROGRAMS;

/// Of this test program alone, so that several may run side by side.
std::string net_name(const char* suffix = "") { return "t" + std::to_string(::getpid()) + suffix; }

NetSpec spec(const char* suffix, std::uint64_t seed) {
  return {.name = net_name(suffix), .modules = 2, .seed = seed};
}

class NetTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!check_rights()) return;
    auto started = OwnedNet::start(spec("", 3), programs);
    ASSERT_TRUE(started.ok()) << started.error().message;
    net = std::make_unique<OwnedNet>(std::move(started).value());
  }
  static void TearDownTestSuite() { net.reset(); }
  void SetUp() override {
    const Status rights = check_rights();
    if (!rights) GTEST_SKIP() << rights.error().message;
    ASSERT_TRUE(net);
    set({"clear"});
  }

  static void set(const std::vector<std::string>& words, const std::string& from = "", const std::string& to = "") {
    const Status status = net->set(from, to, words);
    ASSERT_TRUE(status.ok()) << status.error().message;
  }
  static Udp udp(std::uint32_t host) { return Udp(net->host(host), host_address(host)); }
  /// A counter of the relay's.
  static std::uint64_t counted(const std::string& from, const std::string& to, const char* counter) {
    const auto json = nlohmann::json::parse(*ask_net(net->spec().name, show_request));
    for (const auto& link : json["links"]) {
      if (link["from"] == from && link["to"] == to) return link[counter];
    }
    return 0;
  }
  static std::map<std::uint32_t, int> times_by_number(const std::vector<Datagram>& datagrams) {
    std::map<std::uint32_t, int> times;
    for (const Datagram& datagram : datagrams) ++times[datagram.number];
    return times;
  }
  static std::vector<std::uint32_t> numbers(const std::vector<Datagram>& datagrams) {
    std::vector<std::uint32_t> result;
    for (const Datagram& datagram : datagrams) result.push_back(datagram.number);
    return result;
  }
  /// The least delay of a few datagrams: what a loaded machine adds is not in it.
  static Duration least_delay(Udp& from, const std::string& address, Udp& to) {
    Duration least = 1h;
    for (std::uint32_t number = 0; number < 30; ++number) {
      from.send(address, number);
      if (const auto datagram = to.receive(5s)) least = std::min(least, datagram->delay);
    }
    return least;
  }

  static std::unique_ptr<OwnedNet> net;
};
std::unique_ptr<OwnedNet> NetTest::net;

TEST_F(NetTest, CarriesEveryDatagramOfAnUndisturbedLinkOnceAndInOrder) {
  Udp m1 = udp(1), m2 = udp(2);
  const auto sent_before = counted("m1", "m2", "sent"), beside_before = counted("m1", "operator", "sent");
  send_stream(m1, host_address(2), 1000);
  const auto got = numbers(m2.receive_all());
  EXPECT_EQ(got.size(), 1000u);
  EXPECT_TRUE(std::is_sorted(got.begin(), got.end()));
  // Nothing else was on the air: no ARP, no IGMP, nothing of the kernel's own.
  EXPECT_EQ(counted("m1", "m2", "sent") - sent_before, 1000u);
  EXPECT_EQ(counted("m1", "operator", "sent"), beside_before);
}

TEST_F(NetTest, AddsTheDelayInTheOneDirectionAskedFor) {
  Udp m1 = udp(1), m2 = udp(2);
  set({"delay=40ms"}, "m1", "m2");
  const Duration there = least_delay(m1, host_address(2), m2), back = least_delay(m2, host_address(1), m1);
  EXPECT_GE(there, 40ms);
  EXPECT_LT(there, 60ms);
  EXPECT_LT(back, 20ms);  // the control: without the setting there is no such delay
}

TEST_F(NetTest, LosesAShareWithinBinomialBoundsAndCountsItRightly) {
  constexpr std::uint32_t count = 4000;
  Udp m1 = udp(1), m2 = udp(2);
  set({"loss=20%"}, "m1", "m2");
  const auto lost_before = counted("m1", "m2", "lost");
  send_stream(m1, host_address(2), count);
  const auto received = static_cast<double>(m2.receive_all().size());
  const double share = 1 - received / count, bound = 5 * std::sqrt(0.2 * 0.8 / count);
  EXPECT_NEAR(share, 0.2, bound);
  EXPECT_GT(std::abs(share - 0.25), bound);  // the test can tell 25 % from 20 %
  EXPECT_EQ(static_cast<double>(counted("m1", "m2", "lost") - lost_before), count - received);
}

TEST_F(NetTest, LosesTheSameDatagramsWithTheSameSeedOnly) {
  std::vector<std::vector<std::uint32_t>> got;
  for (const std::uint64_t seed : {11u, 11u, 12u}) {
    auto again = OwnedNet::start(spec("s", seed), programs);
    ASSERT_TRUE(again.ok()) << again.error().message;
    ASSERT_TRUE(again->set("", "", {"loss=30%"}).ok());
    Udp m1(again->host(1), host_address(1)), m2(again->host(2), host_address(2));
    send_stream(m1, host_address(2), 500);
    got.push_back(numbers(m2.receive_all()));
  }
  EXPECT_EQ(got[0], got[1]);
  EXPECT_NE(got[0], got[2]);
}

TEST_F(NetTest, APartitionStopsEverythingUntilItIsHealed) {
  Udp m1 = udp(1), m2 = udp(2), op = udp(operator_host);
  set({"partition=m1+operator/m2"});
  send_stream(m1, host_address(2), 100);
  send_stream(m2, host_address(1), 100);
  m1.send(host_address(operator_host), 7);
  EXPECT_EQ(op.receive_all().size(), 1u);
  EXPECT_EQ(m1.receive_all().size(), 0u);
  EXPECT_EQ(m2.receive_all().size(), 0u);
  set({"partition=none"});
  send_stream(m1, host_address(2), 100);
  EXPECT_EQ(m2.receive_all().size(), 100u);
}

TEST_F(NetTest, ChangesALinkWhileDatagramsFly) {
  Udp m1 = udp(1), m2 = udp(2);
  std::uint32_t number = 0;
  const auto send_some = [&] {
    for (int k = 0; k < 50; ++k) m1.send(host_address(2), number++);
    return m2.receive_all(200ms).size();
  };
  EXPECT_EQ(send_some(), 50u);
  set({"cut=on"}, "m1", "m2");
  EXPECT_EQ(send_some(), 0u);
  set({"cut=off", "duplication=100%"}, "m1", "m2");
  EXPECT_EQ(send_some(), 100u);
  set({"duplication=0"}, "m1", "m2");
  EXPECT_EQ(send_some(), 50u);
}

TEST_F(NetTest, ReorderingLetsLaterDatagramsOvertake) {
  Udp m1 = udp(1), m2 = udp(2);
  set({"reordering=20%", "hold=30ms"}, "m1", "m2");
  send_stream(m1, host_address(2), 200);
  const auto got = numbers(m2.receive_all());
  EXPECT_EQ(got.size(), 200u);
  EXPECT_FALSE(std::is_sorted(got.begin(), got.end()));
}

TEST_F(NetTest, TheMediumSendsNoFasterThanItsRate) {
  Udp m1 = udp(1), m2 = udp(2);
  set({"rate=1Mbit/s", "backlog=10s"});
  constexpr std::uint32_t count = 50;
  constexpr std::size_t payload_bytes = 1000, headers_bytes = 42;  // Ethernet, IPv4, UDP
  const Duration begin = monotonic_now();
  for (std::uint32_t number = 0; number < count; ++number) m1.send(host_address(2), number, payload_bytes);
  for (std::uint32_t number = 0; number < count; ++number) ASSERT_TRUE(m2.receive(5s));
  const double taken_s = to_s(monotonic_now() - begin);
  const double least_s = count * (payload_bytes + headers_bytes) * 8 / 1e6;
  EXPECT_GE(taken_s, least_s);
  EXPECT_LT(taken_s, least_s + 2);
}

TEST_F(NetTest, MulticastReachesEveryHostOnTheRadio) {
  Udp m1 = udp(1), m2 = udp(2), op = udp(operator_host);
  for (std::uint32_t number = 0; number < 20; ++number) m1.send(Udp::group_address, number);
  EXPECT_EQ(m2.receive_all().size(), 20u);
  EXPECT_EQ(op.receive_all().size(), 20u);
}

TEST_F(NetTest, MulticastOnLoopbackStaysInItsHost) {
  Udp one(net->host(1), "127.0.0.1"), other(net->host(2), "127.0.0.1");
  const auto sent_before = counted("m1", "m2", "sent");
  for (std::uint32_t number = 0; number < 20; ++number) one.send(Udp::group_address, number);
  EXPECT_EQ(one.receive_all().size(), 20u);
  EXPECT_EQ(other.receive_all(100ms).size(), 0u);
  EXPECT_EQ(counted("m1", "m2", "sent"), sent_before);
}

TEST_F(NetTest, TwoNetsDoNotHearEachOther) {
  auto beside = OwnedNet::start(spec("b", 3), programs);
  ASSERT_TRUE(beside.ok()) << beside.error().message;
  Udp m1 = udp(1), m2 = udp(2), m2_beside(beside->host(2), host_address(2));
  set({"loss=100%"});
  send_stream(m1, host_address(2), 50);
  EXPECT_EQ(m2.receive_all(200ms).size(), 0u);
  EXPECT_EQ(m2_beside.receive_all(200ms).size(), 0u);
  Udp m1_beside(beside->host(1), host_address(1));
  send_stream(m1_beside, host_address(2), 50);
  EXPECT_EQ(m2_beside.receive_all().size(), 50u);
}

TEST_F(NetTest, ARunningNetOfThatNameIsNotTakenOver) {
  const auto second = OwnedNet::start(spec("", 4), programs);
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find(net_name()), std::string::npos) << second.error().message;
  EXPECT_TRUE(ask_net(net_name(), show_request).ok());
}

}  // namespace
}  // namespace eciton::net
