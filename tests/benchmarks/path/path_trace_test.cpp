// The join of link and ring, by hand: three ticks of two milliseconds.
#include "benchmarks/path/path_trace.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace eciton::bench {
namespace {

constexpr std::int64_t ms = 1'000'000;

TEST(PathTraceTest, SplitsTheWayOfAnImuSampleIntoStages) {
  const std::vector<LinkTick> ticks{
      {.imu_stamp_ns = 99 * ms, .out_ns = 100 * ms, .in_ns = 100 * ms + 300'000, .command = 7}};
  const std::vector<CommandSeen> commands{
      {.stamp_ns = 100 * ms + 200'000, .state_stamp_ns = 100 * ms + 80'000, .print = 7}};
  const PathTrace trace = trace_path(ticks, commands);
  ASSERT_EQ(trace.samples.size(), 1u);
  EXPECT_EQ(trace.samples[0].estimation_ns, 80'000);
  EXPECT_EQ(trace.samples[0].control_ns, 200'000);
  EXPECT_EQ(trace.samples[0].rotors_ns, 300'000);
  EXPECT_EQ(trace.samples[0].age_ns, ms + 300'000);
  EXPECT_EQ(trace.late, 0u);
}

/// What a host that takes the last tick's command for this one's looks like.
TEST(PathTraceTest, CountsACommandMadeOfAnEarlierTicksSampleAsLateAndAddsTheTick) {
  const std::vector<LinkTick> ticks{
      {.imu_stamp_ns = 0, .out_ns = 100 * ms, .in_ns = 0, .command = 0},
      {.imu_stamp_ns = 0, .out_ns = 102 * ms, .in_ns = 102 * ms + 50'000, .command = 7},
      {.imu_stamp_ns = 0, .out_ns = 104 * ms, .in_ns = 104 * ms + 50'000, .command = 8}};
  const std::vector<CommandSeen> commands{{100 * ms + 1'900'000, 100 * ms + 1'800'000, 7},
                                          {102 * ms + 200'000, 102 * ms + 100'000, 8}};
  const PathTrace trace = trace_path(ticks, commands);
  ASSERT_EQ(trace.samples.size(), 2u);
  EXPECT_EQ(trace.samples[0].out_ns, 100 * ms);
  EXPECT_EQ(trace.samples[0].rotors_ns, 2 * ms + 50'000);
  EXPECT_EQ(trace.late, 2u);
  EXPECT_EQ(trace.unanswered, 1u);
}

TEST(PathTraceTest, CountsRepeatedAndUnseenCommandsAndMeasuresNeither) {
  const std::vector<LinkTick> ticks{{.imu_stamp_ns = 0, .out_ns = 2 * ms, .in_ns = 3 * ms, .command = 7},
                                    {.imu_stamp_ns = 0, .out_ns = 4 * ms, .in_ns = 5 * ms, .command = 7},
                                    {.imu_stamp_ns = 0, .out_ns = 6 * ms, .in_ns = 7 * ms, .command = 9}};
  const std::vector<CommandSeen> commands{{.stamp_ns = 2 * ms + 2, .state_stamp_ns = 2 * ms + 1, .print = 7}};
  const PathTrace trace = trace_path(ticks, commands);
  EXPECT_EQ(trace.ticks, 3u);
  EXPECT_EQ(trace.samples.size(), 1u);
  EXPECT_EQ(trace.repeated, 1u);
  EXPECT_EQ(trace.unseen, 1u);
}

TEST(PathTraceTest, LeavesOutACommandMadeBeforeTheTraceBegan) {
  const std::vector<LinkTick> ticks{{.imu_stamp_ns = 0, .out_ns = 4 * ms, .in_ns = 5 * ms, .command = 7}};
  const std::vector<CommandSeen> commands{{.stamp_ns = 3 * ms, .state_stamp_ns = 2 * ms, .print = 7}};
  EXPECT_TRUE(trace_path(ticks, commands).samples.empty());
}

TEST(PathTraceTest, OfTheLinkAloneMeasuresEveryTickWithANewCommand) {
  const std::vector<LinkTick> ticks{{.imu_stamp_ns = 1, .out_ns = 2 * ms, .in_ns = 2 * ms + 40, .command = 7},
                                    {.imu_stamp_ns = 1, .out_ns = 4 * ms, .in_ns = 4 * ms + 30, .command = 7},
                                    {.imu_stamp_ns = 1, .out_ns = 6 * ms, .in_ns = 6 * ms + 20, .command = 8}};
  const PathTrace trace = trace_link(ticks);
  ASSERT_EQ(trace.samples.size(), 2u);
  EXPECT_EQ(trace.samples[0].rotors_ns, 40);
  EXPECT_EQ(trace.samples[1].rotors_ns, 20);
  EXPECT_EQ(trace.repeated, 1u);
}

TEST(CommandPrintTest, TellsSetpointsApartByTheirLastBitAndTheirPlace) {
  std::array<RotorPrint, 2> rotors{{{3.0, {0.1, 0.2}}, {4.0, {0, 0}}}};
  const std::uint64_t print = command_print(rotors);
  EXPECT_EQ(command_print(rotors), print);
  rotors[0].thrust_N = std::nextafter(3.0, 4.0);
  EXPECT_NE(command_print(rotors), print);
  const std::array<RotorPrint, 2> swapped{{{4.0, {0, 0}}, {3.0, {0.1, 0.2}}}};
  EXPECT_NE(command_print(swapped), print);
}

}  // namespace
}  // namespace eciton::bench
