// From records to times, against cases computed by hand.
#include "benchmarks/latency/stream.hpp"

#include <gtest/gtest.h>

namespace eciton::bench {
namespace {

Block block_of(std::vector<SampleRecord> ping, std::vector<SampleRecord> echo) {
  Block block;
  block.ping.records = std::move(ping);
  block.echo.records = std::move(echo);
  return block;
}

SampleRecord echoed(std::int64_t received_ns) {
  SampleRecord record;
  record.received_ns = received_ns;
  return record;
}

TEST(StreamTest, TimesBeginWithTheSendingAndWithThePlan) {
  Stream stream;
  // Planned at 1 ms, the sleep ended 20 µs late, there in 30 µs, back in 40 µs.
  stream.add(block_of({{1'000'000, 900'000, 1'020'000, 1'090'000, 0}}, {echoed(1'050'000)}), 0);
  ASSERT_EQ(stream.round_trip_us.size(), 1u);
  EXPECT_DOUBLE_EQ(stream.round_trip_us[0][0], 70);
  EXPECT_DOUBLE_EQ(stream.from_plan_us[0], 90);
  EXPECT_DOUBLE_EQ(stream.there_us[0], 30);
  EXPECT_DOUBLE_EQ(stream.back_us[0], 40);
  EXPECT_DOUBLE_EQ(stream.late_us[0], 20);
  EXPECT_DOUBLE_EQ(stream.at_s[0], 0.001);
  EXPECT_EQ(stream.held_up, 0u);
}

TEST(StreamTest, ASenderThatWasHeldUpDoesNotHideIt) {
  Stream stream;
  // The sample before kept the sender until 5 ms; this one was due at 2 ms: it waited 3 ms, whoever's fault it was.
  stream.add(block_of({{2'000'000, 5'000'000, 5'001'000, 5'100'000, 0}}, {echoed(5'050'000)}), 0);
  EXPECT_DOUBLE_EQ(stream.round_trip_us[0][0], 3100);
  EXPECT_DOUBLE_EQ(stream.there_us[0], 3050);
  EXPECT_EQ(stream.held_up, 1u);
}

TEST(StreamTest, CountsLossDuplicatesAndWhatWasNeverSent) {
  Stream stream;
  Block block =
      block_of({{1, 0, 2, 0, 0}, {3, 0, 4, 5000, 2}, {0, 0, 0, 0, 0}}, {echoed(0), echoed(3000), echoed(0)});
  block.ping.corrupt = 1;
  block.echo.refused = 4;
  stream.add(block, 0);
  EXPECT_EQ(stream.sent, 2u);
  EXPECT_EQ(stream.lost, 1u);
  EXPECT_EQ(stream.duplicates, 2u);
  EXPECT_EQ(stream.corrupt, 1u);
  EXPECT_EQ(stream.refused, 4u);
  EXPECT_EQ(stream.round_trip_us[0].size(), 1u);
}

TEST(StreamTest, IsPartialWithFewerBlocksThanAskedFor) {
  Stream stream;
  stream.blocks_asked = 2;
  stream.add({}, 0);
  EXPECT_TRUE(stream.partial());
  stream.add({}, 0);
  EXPECT_FALSE(stream.partial());
}

TEST(StreamTest, AddsUpWhatTheProcessesSpent) {
  Stream stream;
  Block block;
  block.ping.usage = {2'000'000, 3, 4, 5, 1'000'000};
  block.echo.usage = {0, 0, 0, -1, 0};
  stream.add(block, 0);
  stream.add(block, 0);
  EXPECT_DOUBLE_EQ(stream.ping.cpu_us, 4000);
  EXPECT_DOUBLE_EQ(stream.ping.switches, 14);
  EXPECT_DOUBLE_EQ(stream.ping.allocations, 10);
  EXPECT_DOUBLE_EQ(stream.ping.rss_MB_max, 1);
  EXPECT_TRUE(stream.ping.allocations_counted);
  EXPECT_FALSE(stream.echo.allocations_counted);
}

}  // namespace
}  // namespace eciton::bench
