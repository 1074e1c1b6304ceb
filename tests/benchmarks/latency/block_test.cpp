// What a peer records, and that it survives the way through a pipe.
#include "benchmarks/latency/peers/block.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace eciton::bench {
namespace {

TEST(BlockTest, CountsWhatArrivesTwiceDamagedOrFromAnotherBlock) {
  BlockRecorder recorder;
  recorder.begin(100, 3);
  for (std::uint32_t k = 0; k < 3; ++k) recorder.sending(k, 1000 + k, 900 + k, 1010 + k);
  recorder.received(100, 2000, true);
  recorder.received(102, 2002, false);
  recorder.received(100, 2003, true);
  recorder.received(99, 2004, true);
  recorder.received(103, 2005, true);
  EXPECT_EQ(recorder.received_count(), 2u);
  const BlockReport report = recorder.report();
  ASSERT_EQ(report.records.size(), 3u);
  EXPECT_EQ(report.records[0].received_ns, 2000);  // the first time counts
  EXPECT_EQ(report.records[0].duplicates, 1u);
  EXPECT_EQ(report.records[1].received_ns, 0);
  EXPECT_EQ(report.records[2].sent_ns, 1012);
  EXPECT_EQ(report.corrupt, 1);
  EXPECT_EQ(report.stale, 2);
}

TEST(BlockTest, ABlockForgetsTheOneBefore) {
  BlockRecorder recorder;
  recorder.begin(0, 2);
  recorder.received(0, 5, true);
  recorder.refused();
  recorder.begin(2, 2);
  const BlockReport report = recorder.report();
  EXPECT_EQ(report.records[0].received_ns, 0);
  EXPECT_EQ(report.refused, 0);
  EXPECT_EQ(recorder.received_count(), 0u);
}

TEST(BlockTest, SequenceNumbersMayWrap) {
  BlockRecorder recorder;
  recorder.begin(0xffffffffu, 2);
  recorder.received(0xffffffffu, 7, true);
  recorder.received(0, 8, true);
  EXPECT_EQ(recorder.report().records[1].received_ns, 8);
}

TEST(BlockTest, TextReadsBackAsItWas) {
  BlockReport report;
  report.records = {{1, 2, 3, 4, 5}, {6, 7, 8, 0, 0}};
  report.usage = {11, 12, 13, -1, 15};
  report.refused = 16;
  report.corrupt = 17;
  report.stale = 18;
  std::istringstream lines(to_text(report));
  std::string line;
  std::getline(lines, line);
  BlockReport back;
  ASSERT_EQ(parse_head(line, back), 2);
  while (std::getline(lines, line)) ASSERT_TRUE(parse_record(line, back.records.emplace_back()));
  EXPECT_EQ(to_text(back), to_text(report));
  EXPECT_EQ(back.usage.allocations, -1);
  EXPECT_EQ(back.records[1].sent_ns, 8);
}

TEST(BlockTest, RefusesWhatIsNoBlock) {
  BlockReport report;
  EXPECT_EQ(parse_head("", report), -1);
  EXPECT_EQ(parse_head("block 2 1 2", report), -1);
  EXPECT_EQ(parse_head("block 99999999 1 2 3 4 5 6 7 8", report), -1);
  SampleRecord record;
  EXPECT_FALSE(parse_record("1 2 3", record));
}

}  // namespace
}  // namespace eciton::bench
