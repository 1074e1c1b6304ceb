// The words of ddsperf 0.10.2, taken down from a run.
#include "benchmarks/latency/ddsperf.hpp"

#include <gtest/gtest.h>

namespace eciton::bench {
namespace {

TEST(DdsperfTest, ReportsHalfOfEachRoundTrip) {
  const auto window = parse_ddsperf(
      "[23735] 1.000  vm:23734 size 256 mean 40.209us min 16.960us 50% 39.544us 90% 48.136us 99% 62.365us max "
      "488.586us cnt 969");
  ASSERT_TRUE(window);
  EXPECT_DOUBLE_EQ(window->mean_us, 80.418);
  EXPECT_DOUBLE_EQ(window->p50_us, 79.088);
  EXPECT_DOUBLE_EQ(window->p90_us, 96.272);
  EXPECT_DOUBLE_EQ(window->p99_us, 124.730);
  EXPECT_DOUBLE_EQ(window->max_us, 977.172);
  EXPECT_EQ(window->count, 969u);
}

TEST(DdsperfTest, OtherLinesAreNoWindow) {
  EXPECT_FALSE(parse_ddsperf("[23735] participant vm:23734: new"));
  EXPECT_FALSE(parse_ddsperf("[23735] 1.000  rss:7.3MB vcsw:3472 ivcsw:1672 ddsperf:4%+0% recvUC:1%+0%"));
  EXPECT_FALSE(parse_ddsperf("size 256 mean unknown"));
}

}  // namespace
}  // namespace eciton::bench
