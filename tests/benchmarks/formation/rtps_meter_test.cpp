// Frames made by hand after the RTPS specification, byte by byte.
#include "benchmarks/formation/rtps_meter.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace eciton::bench {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Bytes little16(std::uint32_t value) {
  return {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8)};
}

/// 14 bytes of Ethernet, 20 of IPv4, 8 of UDP.
Bytes frame(const Bytes& payload, std::uint16_t fragment = 0, bool multicast = false) {
  Bytes ethernet(14, 0);
  if (multicast) ethernet[0] = 1;
  ethernet[12] = 0x08;
  Bytes ip(20, 0);
  ip[0] = 0x45;
  ip[4] = 0x12;  // identification
  ip[6] = static_cast<std::uint8_t>(fragment >> 8);
  ip[7] = static_cast<std::uint8_t>(fragment);
  ip[9] = 17;
  return ethernet + ip + ((fragment & 0x1fff) == 0 ? Bytes(8, 0) : Bytes{}) + payload;
}

const Bytes prefix_a(12, 0xaa), prefix_b(12, 0xbb);

Bytes message(const Bytes& prefix, const Bytes& submessages) {
  return Bytes{'R', 'T', 'P', 'S', 2, 1, 1, 16} + prefix + submessages;
}

Bytes submessage(std::uint8_t kind, std::uint8_t flags, const Bytes& body) {
  return Bytes{kind, flags} + little16(static_cast<std::uint32_t>(body.size())) + body;
}

const Bytes nobody{0, 0, 0, 0}, spdp_writer{0, 1, 0, 0xc2}, sedp_writer{0, 0, 3, 0xc2}, alive_writer{0, 2, 0, 0xc2},
    user_writer{0, 0, 0x12, 0x02}, other_writer{0, 0, 0x13, 0x02};

Bytes data(const Bytes& writer, const Bytes& payload) {
  return submessage(0x15, 0x05, Bytes{0, 0} + little16(16) + nobody + writer + Bytes(8, 0) + payload);
}
Bytes heartbeat(const Bytes& writer) { return submessage(0x07, 0x01, nobody + writer + Bytes(20, 0)); }
Bytes acknack(const Bytes& writer) { return submessage(0x06, 0x01, nobody + writer + Bytes(16, 0)); }
Bytes to(const Bytes& prefix) { return submessage(0x0e, 0x01, prefix); }

Bytes announcement(const Bytes& prefix, const Bytes& writer, const std::string& topic) {
  Bytes name =
      little16(static_cast<std::uint32_t>(topic.size() + 1)) + Bytes{0, 0} + Bytes(topic.begin(), topic.end());
  do {
    name.push_back(0);
  } while (name.size() % 4 != 0);
  return data(sedp_writer, Bytes{0, 3, 0, 0} + little16(0x0005) + little16(static_cast<std::uint32_t>(name.size())) +
                               name + little16(0x005a) + little16(16) + prefix + writer + little16(1) + little16(0));
}

void add(RtpsMeter& meter, const Bytes& frame) { meter.add(frame, static_cast<std::uint32_t>(frame.size())); }

TEST(RtpsMeterTest, SortsBuiltinTrafficByItsWriter) {
  RtpsMeter meter;
  const Bytes spdp = frame(message(prefix_a, data(spdp_writer, Bytes(100, 0))), 0, true);
  const Bytes sedp = frame(message(prefix_a, heartbeat(sedp_writer)));
  const Bytes alive = frame(message(prefix_a, data(alive_writer, Bytes(20, 0))));
  for (const Bytes& f : {spdp, sedp, alive}) add(meter, f);
  EXPECT_EQ(meter.of(RtpsUse::participants).bytes, spdp.size());
  EXPECT_EQ(meter.of(RtpsUse::endpoints).bytes, sedp.size());
  EXPECT_EQ(meter.of(RtpsUse::liveliness).bytes, alive.size());
  EXPECT_EQ(meter.discovery().bytes, spdp.size() + sedp.size() + alive.size());
  EXPECT_EQ(meter.discovery().packets, 3u);
  EXPECT_EQ(meter.multicast().packets, 1u);
  EXPECT_EQ(meter.multicast().bytes, spdp.size());
  EXPECT_EQ(meter.of(RtpsUse::topics).packets, 0u);
}

TEST(RtpsMeterTest, KnowsATopicByItsAnnouncedWriterAndAcknowledgementsByTheirDestination) {
  RtpsMeter meter;
  add(meter, frame(message(prefix_a, announcement(prefix_a, user_writer, "beacon"))));
  const Bytes sample = frame(message(prefix_a, data(user_writer, Bytes(40, 0))));
  const Bytes answer = frame(message(prefix_b, to(prefix_a) + acknack(user_writer)));
  const Bytes stranger = frame(message(prefix_a, data(other_writer, Bytes(40, 0))));
  for (const Bytes& f : {sample, answer, stranger}) add(meter, f);
  EXPECT_EQ(meter.topics().at("beacon").bytes, sample.size() + answer.size());
  EXPECT_EQ(meter.topics().at("?").bytes, stranger.size());
  // A restart counts anew and has not forgotten the writer.
  meter.restart();
  add(meter, sample);
  EXPECT_EQ(meter.topics().at("beacon").bytes, sample.size());
  EXPECT_EQ(meter.total().packets, 1u);
}

TEST(RtpsMeterTest, SharesAPacketsHeadersAmongItsSubmessages) {
  RtpsMeter meter;
  const Bytes body = heartbeat(sedp_writer);
  const Bytes both = frame(message(prefix_a, body + heartbeat(user_writer)));
  add(meter, both);
  EXPECT_EQ(meter.of(RtpsUse::endpoints).bytes, both.size() / 2);
  EXPECT_EQ(meter.of(RtpsUse::topics).bytes, both.size() / 2);
}

TEST(RtpsMeterTest, CountsThatNobodyListensAsDiscovery) {
  RtpsMeter meter;
  Bytes refusal = frame(Bytes(60, 0));
  refusal[14 + 9] = 1;   // ICMP ...
  refusal[14 + 20] = 3;  // ... destination unreachable
  add(meter, refusal);
  EXPECT_EQ(meter.discovery().bytes, refusal.size());
  refusal[14 + 20] = 8;  // echo request
  add(meter, refusal);
  EXPECT_EQ(meter.of(RtpsUse::other).bytes, refusal.size());
}

TEST(RtpsMeterTest, CountsLaterFragmentsAsTheirFirst) {
  RtpsMeter meter;
  const Bytes first = frame(message(prefix_a, data(sedp_writer, Bytes(1400, 0))), 0x2000);
  const Bytes second = frame(Bytes(300, 0), 0x00b9);
  add(meter, first);
  add(meter, second);
  EXPECT_EQ(meter.of(RtpsUse::endpoints).bytes, first.size() + second.size());
}

TEST(RtpsMeterTest, WhatIsNotRtpsOrCutShortIsOtherAndHurtsNobody) {
  RtpsMeter meter;
  const Bytes whole = frame(message(prefix_a, announcement(prefix_a, user_writer, "beacon")));
  std::uint64_t bytes = 0;
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    add(meter, Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    bytes += size;
  }
  EXPECT_EQ(meter.total().bytes, bytes);
  RtpsMeter other;
  add(other, frame(Bytes{'h', 'e', 'l', 'l', 'o'}));
  add(other, Bytes(60, 0xff));
  EXPECT_EQ(other.of(RtpsUse::other).packets, 2u);
}

}  // namespace
}  // namespace eciton::bench
