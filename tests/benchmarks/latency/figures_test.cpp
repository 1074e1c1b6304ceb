// Figures of made-up streams whose ratios are known.
#include "benchmarks/latency/figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace eciton::bench {
namespace {

constexpr std::size_t blocks = 30;

/// Every block the same hundred round trips, 1 to 100 times `unit_us`.
Stream stream_of(const std::string& lane, Kind kind, const std::string& vendor, const std::string& delivery,
                 const Cell& cell, std::int64_t unit_us) {
  Stream stream;
  stream.lane = lane;
  stream.label = lane;
  stream.kind = kind;
  stream.vendor = vendor;
  stream.delivery = delivery;
  stream.cell = cell;
  stream.blocks_asked = blocks;
  Block block;
  for (std::int64_t k = 1; k <= 100; ++k) {
    const std::int64_t sent_ns = 1'000'000 * k + 10'000;
    block.ping.records.push_back({1'000'000 * k, 0, sent_ns, sent_ns + k * unit_us * 1000, 0});
    SampleRecord echo;
    echo.received_ns = sent_ns + k * unit_us * 500;
    block.echo.records.push_back(echo);
  }
  block.ping.usage = {1'000'000, 100, 0, 0, 5'000'000};
  block.echo.usage = {2'000'000, 200, 0, 100, 6'000'000};
  for (std::size_t b = 0; b < blocks; ++b) stream.add(block, 0);
  return stream;
}

struct Made {
  LatencyOptions options;
  Plan plan;
  Measured measured;
  Overhead overhead{100, 110, 0, 0.5, {}};
  Result result() const { return latency_result(options, plan, measured, overhead); }
};

Made run_of_one_cell() {
  Made made;
  const Cell cell{256, 1000, "sensor", "loopback", true};
  made.plan.cells = {cell};
  made.measured.streams = {stream_of("ours.cyclonedds.wake", Kind::ours, "cyclonedds", "wake", cell, 3),
                           stream_of("native.cyclonedds.wake", Kind::native, "cyclonedds", "wake", cell, 2),
                           stream_of("udp", Kind::foreign, "", "", cell, 1)};
  return made;
}

double metric(const Result& result, const std::string& name) {
  return result.metrics.contains(name) ? result.metrics[name].get<double>() : std::nan("");
}

std::string row_with(const Result& result, const std::string& begin, const std::string& second) {
  for (const Table& table : result.tables) {
    for (const auto& row : table.rows) {
      if (row[0].starts_with(begin) && row[1] == second) return row.back();
    }
  }
  return "no such row";
}

TEST(FiguresTest, RatiosBearTheNamesThatTheGateReads) {
  const Result result = run_of_one_cell().result();
  EXPECT_DOUBLE_EQ(metric(result, "tax_p50.cyclonedds.wake.256"), 1.5);
  EXPECT_DOUBLE_EQ(metric(result, "tax_p50_low.cyclonedds.wake.256"), 1.5);
  EXPECT_DOUBLE_EQ(metric(result, "tax_p50_high.cyclonedds.wake.256"), 1.5);
  EXPECT_DOUBLE_EQ(metric(result, "tax_p99.cyclonedds.wake.256"), 1.5);
  EXPECT_DOUBLE_EQ(metric(result, "over_udp_p50.cyclonedds.wake.256"), 3);
  EXPECT_DOUBLE_EQ(metric(result, "round_trip_us_p50.udp.256"), 60);  // the 50th of 100, and 10 from the plan
  EXPECT_DOUBLE_EQ(metric(result, "one_way_us_p50.udp.256"), 25);
  EXPECT_DOUBLE_EQ(metric(result, "cpu_us.udp.256"), 30);  // 1 and 2 ms for 100 samples
  EXPECT_DOUBLE_EQ(metric(result, "switches.udp.256"), 3);
  EXPECT_DOUBLE_EQ(metric(result, "allocations.udp.256"), 1);
  EXPECT_DOUBLE_EQ(metric(result, "rss_MB.udp.256"), 11);
  EXPECT_DOUBLE_EQ(metric(result, "loss.udp.256"), 0);
  EXPECT_FALSE(result.partial);
}

TEST(FiguresTest, SaysWhichBarIsMissed) {
  const Result result = run_of_one_cell().result();
  EXPECT_EQ(row_with(result, "ours.cyclonedds.wake / native", "p50"), "missed");
  EXPECT_EQ(row_with(result, "ours.cyclonedds.wake / native", "p99"), "missed");
  EXPECT_EQ(row_with(result, "ours.cyclonedds.wake / udp", "p50"), "held");  // 3 of 4
  Made equal = run_of_one_cell();
  equal.measured.streams[0] =
      stream_of("ours.cyclonedds.wake", Kind::ours, "cyclonedds", "wake", equal.plan.cells[0], 2);
  EXPECT_EQ(row_with(equal.result(), "ours.cyclonedds.wake / native", "p50"), "held");
}

TEST(FiguresTest, AMedianIsJudgedByItsUpperBound) {
  Made made = run_of_one_cell();
  // Every other block of ours is twice as slow: the median is that of the fast ones, but not surely.
  Stream& ours = made.measured.streams[0];
  ours = stream_of("ours.cyclonedds.wake", Kind::ours, "cyclonedds", "wake", made.plan.cells[0], 2);
  for (std::size_t b = 0; b < blocks / 3; ++b) {
    for (double& value : ours.round_trip_us[b]) value *= 3;
  }
  const Result result = made.result();
  EXPECT_GT(metric(result, "tax_p50_high.cyclonedds.wake.256"), metric(result, "tax_p50.cyclonedds.wake.256"));
  EXPECT_EQ(row_with(result, "ours.cyclonedds.wake / native", "p50"), "missed");
}

TEST(FiguresTest, OtherCellsHaveNamesOfTheirOwn) {
  Made made = run_of_one_cell();
  const Cell other{256, 500, "command", "hosts", false};
  made.plan.cells.push_back(other);
  for (Stream stream : {stream_of("ours.cyclonedds.wake", Kind::ours, "cyclonedds", "wake", other, 4),
                        stream_of("native.cyclonedds.wake", Kind::native, "cyclonedds", "wake", other, 1)}) {
    made.measured.streams.push_back(std::move(stream));
  }
  const Result result = made.result();
  EXPECT_DOUBLE_EQ(metric(result, "tax_p50.cyclonedds.wake.256"), 1.5);
  EXPECT_DOUBLE_EQ(metric(result, "tax_p50.cyclonedds.wake.256.command.500.hosts"), 4);
}

TEST(FiguresTest, MixedPairsHaveTimesButNoTax) {
  Made made = run_of_one_cell();
  made.measured.streams.push_back(
      stream_of("ours.cyclonedds-fastdds.wake", Kind::ours, "", "wake", made.plan.cells[0], 2));
  const Result result = made.result();
  EXPECT_TRUE(result.metrics.contains("round_trip_us_p50.ours.cyclonedds-fastdds.wake.256"));
  for (const auto& [name, value] : result.metrics.items()) {
    EXPECT_FALSE(name.starts_with("tax") && name.find("cyclonedds-fastdds") != std::string::npos) << name;
  }
}

TEST(FiguresTest, KeepsRawSamplesWithTheirLoss) {
  Made made = run_of_one_cell();
  made.measured.streams[2].lost = 7;
  const Result result = made.result();
  const auto udp = std::find_if(result.samples.begin(), result.samples.end(),
                                [](const Samples& each) { return each.name == "round_trip.udp.256"; });
  ASSERT_NE(udp, result.samples.end());
  EXPECT_EQ(udp->values.size(), 100 * blocks);
  EXPECT_EQ(udp->at_s.size(), udp->values.size());
  EXPECT_EQ(udp->lost, 7u);
}

TEST(FiguresTest, AnInterruptedRunIsToldAsFarAsItCame) {
  Made made = run_of_one_cell();
  made.measured.interrupted = made.measured.partial = true;
  made.measured.streams[2].round_trip_us.clear();
  made.measured.streams[2].sent = 0;
  const Result result = made.result();
  EXPECT_TRUE(result.partial);
  EXPECT_EQ(result.notes.back(), "Interrupted: these are the figures up to then.");
  EXPECT_TRUE(std::isnan(metric(result, "over_udp_p50.cyclonedds.wake.256")));
  EXPECT_FALSE(std::isnan(metric(result, "tax_p50.cyclonedds.wake.256")));
}

TEST(FiguresTest, NothingMeasuredIsNoCrash) {
  Made made;
  made.plan.cells = {{64, 1000, "sensor", "loopback", true}};
  made.overhead.trouble = "eciton-bench-overhead ended with status 1";
  const Result result = made.result();
  EXPECT_TRUE(result.metrics.empty());
  EXPECT_EQ(result.notes.front(),
            "the framework's own code was not measured: eciton-bench-overhead ended with status 1");
}

}  // namespace
}  // namespace eciton::bench
