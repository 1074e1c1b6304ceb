// What cyclictest and the kernel print, as they print it.
#include <gtest/gtest.h>

#include "benchmarks/jitter/background.hpp"
#include "benchmarks/jitter/cyclictest.hpp"

namespace eciton::bench {
namespace {

TEST(CyclictestTest, TakesEverySampleAndNoOtherLine) {
  // As rt-tests 2.4 prints it with --verbose --nsecs.
  const char* output =
      "WARN: not setting cpu_dma_latency from cyclictest\n"
      "Max CPUs = 2\n"
      "Online CPUs = 2\n"
      "Thread 0 Interval: 2500\n"
      "       0:       0:   37360\n"
      "       0:       1:   32548\n"
      "       0:      10: 5037029\n"
      "T: 0 (14054) P:80 I:2000 C:   1000 Min:  11034 Act:   24749 Avg:   28777 Max:  193786\n";
  EXPECT_EQ(parse_cyclictest_us(output), (std::vector<double>{37.36, 32.548, 5037.029}));
}

TEST(CyclictestTest, OfNothingOrHalfALineTakesNothing) {
  EXPECT_TRUE(parse_cyclictest_us("").empty());
  EXPECT_TRUE(parse_cyclictest_us("   0:   1:").empty());
  EXPECT_TRUE(parse_cyclictest_us("Unable to change scheduling policy!\n0 1 2\n").empty());
}

TEST(CyclictestTest, AToolThatIsNotThereIsNamedWithItsPackage) {
  const auto tool = find_tool("cyclictest-of-nobody", "rt-tests");
  ASSERT_FALSE(tool);
  EXPECT_NE(tool.error().message.find("cyclictest-of-nobody"), std::string::npos);
  EXPECT_NE(tool.error().message.find("apt install rt-tests"), std::string::npos);
  EXPECT_TRUE(find_tool("sh", "dash"));
}

TEST(CyclictestTest, WhatItSaysWhenItDoesNotMeasureIsTheError) {
  const auto shell = find_tool("false", "coreutils");
  ASSERT_TRUE(shell);
  const runtime::StopFlag stop;
  const auto run = run_cyclictest(*shell, {.seconds = 0.1}, stop);
  ASSERT_FALSE(run);
  EXPECT_NE(run.error().message.find("measured nothing"), std::string::npos);
}

TEST(StolenTest, IsTheEighthFigureOfTheFirstLineInTicks) {
  const char* stat = "cpu  100 1 200 3000 4 5 6 250 9 10\ncpu0 50 0 100 1500 2 2 3 125 4 5\n";
  EXPECT_EQ(parse_stolen(stat, 100), std::chrono::milliseconds(2500));
}

TEST(StolenTest, OfAnythingElseIsUnknown) {
  EXPECT_FALSE(parse_stolen("", 100));
  EXPECT_FALSE(parse_stolen("cpu 1 2 3 4", 100));
  EXPECT_FALSE(parse_stolen("intr 1 2 3 4 5 6 7 8 9", 100));
}

}  // namespace
}  // namespace eciton::bench
