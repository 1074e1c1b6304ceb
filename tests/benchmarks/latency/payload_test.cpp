// The payloads are as long as they are called, in memory and on the wire.
#include <gtest/gtest.h>

#include "benchmarks/idl/payload.hpp"
#include "benchmarks/latency/peers/raw_payload.hpp"
#include "core/bus/codec.hpp"

namespace eciton::bench {
namespace {

template <class Payload>
void expect_bytes(std::size_t bytes) {
  EXPECT_EQ(sizeof(Payload), bytes);
  EXPECT_EQ(bus::TypeTraits<Payload>::size_max, bytes + bus::encapsulation_size);
  // Little-endian CDR of this struct has no padding: behind the header it is the memory, which is what the transports
  // without CDR carry.
  Payload payload{};
  payload.number = 7;
  payload.stamp_ns = 8;
  fill(payload.values);
  std::vector<std::uint8_t> cdr(bytes + bus::encapsulation_size);
  ASSERT_EQ(bus::encode(payload, cdr), cdr.size());
  RawPayload raw;
  raw.resize(static_cast<std::uint32_t>(bytes));
  const auto carried = raw.with({7, 8});
  EXPECT_EQ(std::memcmp(cdr.data() + bus::encapsulation_size + 4, carried.data() + 4, bytes - 4), 0);
}

TEST(PayloadTest, IsAsLongAsItIsCalled) {
  expect_bytes<Payload64>(64);
  expect_bytes<Payload256>(256);
  expect_bytes<Payload1024>(1024);
  expect_bytes<Payload4096>(4096);
}

struct Kept final : Sink {
  void arrived(const Mark& mark, bool intact) noexcept override {
    last = mark;
    good += intact ? 1 : 0;
    ++count;
  }
  Mark last;
  int count = 0, good = 0;
};

TEST(PayloadTest, ALostEndShows) {
  RawPayload raw;
  raw.resize(256);
  const auto sent = raw.with({3, 4});
  std::vector<std::byte> bytes(sent.begin(), sent.end());
  Kept kept;
  give(bytes, kept);
  EXPECT_EQ(kept.good, 1);
  EXPECT_EQ(kept.last.sequence, 3u);
  EXPECT_EQ(kept.last.stamp_ns, 4);
  std::fill(bytes.end() - 8, bytes.end(), std::byte{0});
  give(bytes, kept);
  EXPECT_EQ(kept.count, 2);
  EXPECT_EQ(kept.good, 1);
  give(std::span(bytes).first(10), kept);  // no payload at all
  EXPECT_EQ(kept.count, 2);
}

}  // namespace
}  // namespace eciton::bench
