// What people read, against the exact text.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "benchmarks/report/result.hpp"

namespace eciton::bench {
namespace {

TEST(NumberTextTest, KeepsThreeDigitsAndGroupsThousands) {
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(1), "1.00");
  EXPECT_EQ(number_text(9.996), "10.0");
  EXPECT_EQ(number_text(12.34), "12.3");
  EXPECT_EQ(number_text(123.4), "123");
  EXPECT_EQ(number_text(999.7), "1,000");
  EXPECT_EQ(number_text(1234567), "1,234,567");
  EXPECT_EQ(number_text(-0.5), "-0.500");
  EXPECT_EQ(number_text(0.00012), "1.20e-04");
  EXPECT_EQ(number_text(3e20), "3e+20");
  EXPECT_EQ(number_text(std::nan("")), "–");
  EXPECT_EQ(number_text(-std::numeric_limits<double>::infinity()), "-∞");
  EXPECT_EQ(interval_text({0.99, 1.02, 1.06}), "1.02 [0.990, 1.06]");
}

TEST(ReportTextTest, AlignsNamesLeftAndFiguresRight) {
  Result result;
  result.title = "Latency";
  result.clock = "monotonic";
  result.seed = 3;
  result.tables.push_back(
      {"Round trip", {"", "p50 µs", "p99"}, {{"ours", "12.1", "40.0"}, {"raw UDP", "9", "1,000"}}});
  result.notes = {"LCM is not installed: no figures."};
  result.partial = true;
  EXPECT_EQ(to_text(result),
            "Latency (partial), monotonic clock, seed 3\n"
            "\n"
            "Round trip\n"
            "           p50 µs    p99\n"
            "  ours       12.1   40.0\n"
            "  raw UDP       9  1,000\n"
            "\n"
            "  LCM is not installed: no figures.\n");
}

TEST(SummaryTableTest, LeavesOutQuantilesThatItsCountDoesNotResolve) {
  Samples samples{.name = "ours", .unit = "us"};
  for (int i = 1; i <= 100; ++i) samples.values.push_back(i);
  samples.partial = true;
  const Table table = summary_table("", {samples});
  EXPECT_EQ(table.rows.at(0), (std::vector<std::string>{"ours (partial)", "us", "100", "50.5", "50.0", "90.0", "99.0",
                                                        "–", "–", "100", "1.00", "–", "–", "–"}));
  ASSERT_EQ(table.columns.size(), table.rows[0].size());
  samples.sent = 102;
  samples.lost = 2;
  EXPECT_EQ(summary_table("", {samples}).rows[0][12], "2");
}

}  // namespace
}  // namespace eciton::bench
