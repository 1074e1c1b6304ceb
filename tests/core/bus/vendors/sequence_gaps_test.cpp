// What is missing among the numbers of each writer's samples.
#include "core/bus/vendors/sequence_gaps.hpp"

#include <gtest/gtest.h>

namespace eciton::bus::vendors {
namespace {

WriterGuid writer(std::uint8_t name) { return {name}; }

TEST(SequenceGapsTest, CountsWhatIsMissingBetweenTheFirstAndTheLast) {
  SequenceGaps gaps;
  for (const std::int64_t number : {7, 8, 12, 13, 20}) gaps.observe(writer(1), number);
  EXPECT_EQ(gaps.missing(), 3u + 6u);
}

TEST(SequenceGapsTest, KeepsWritersApart) {
  SequenceGaps gaps;
  gaps.observe(writer(1), 1);
  gaps.observe(writer(2), 1000);
  gaps.observe(writer(1), 3);
  gaps.observe(writer(2), 1001);
  EXPECT_EQ(gaps.missing(), 1u);
}

TEST(SequenceGapsTest, MindsNoOrder) {
  SequenceGaps gaps;
  for (const std::int64_t number : {5, 9, 3, 7, 8}) gaps.observe(writer(1), number);
  EXPECT_EQ(gaps.missing(), 2u);  // 4 and 6
}

TEST(SequenceGapsTest, ForgetsThePastOfAWriterOnce) {
  SequenceGaps gaps;
  for (const std::int64_t number : {10, 20, 30}) gaps.observe(writer(1), number);
  EXPECT_EQ(gaps.missing(), 18u);
  gaps.forget_the_past();
  EXPECT_EQ(gaps.missing(), 0u);
  gaps.observe(writer(1), 33);
  gaps.forget_the_past();
  EXPECT_EQ(gaps.missing(), 2u);
  gaps.observe(writer(2), 1);
  gaps.observe(writer(2), 5);
  gaps.forget_the_past();
  EXPECT_EQ(gaps.missing(), 2u);
}

TEST(SequenceGapsTest, KeepsTheCountOfWritersItForgets) {
  SequenceGaps gaps;
  for (std::uint8_t k = 1; k <= 100; ++k) {
    gaps.observe(writer(k), 1);
    gaps.observe(writer(k), 3);
  }
  EXPECT_EQ(gaps.missing(), 100u);
  gaps.observe(writer(100), 5);
  EXPECT_EQ(gaps.missing(), 101u);
}

TEST(SequenceGapsTest, LeavesOutWhatHasNoNumber) {
  SequenceGaps gaps;
  for (int k = 0; k < 10; ++k) gaps.observe(writer(0), 0);
  gaps.observe(writer(0), 5);
  EXPECT_EQ(gaps.missing(), 0u);
}

}  // namespace
}  // namespace eciton::bus::vendors
