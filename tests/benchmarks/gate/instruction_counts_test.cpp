// The comparing of instruction counts: what passes, and above all what must not.
#include "benchmarks/gate/instruction_counts.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace eciton::bench {
namespace {

const std::string ran = "x86_64 GNU 12.2.0 -O2\n100\ncodec/encode\ncontrol/step\n";

/// As callgrind writes its dumps.
std::string callgrind(int encode, int step) {
  std::string text = "# callgrind format\nversion: 1\n";
  int part = 0;
  for (const int total : {encode, step, 0}) {
    text += "\npart: " + std::to_string(++part) + "\n\nevents: Ir\nsummary: " + std::to_string(total) +
            "\n\nfn=(1) eciton_counted_steps\n0 5\n\ntotals: " + std::to_string(total) + "\n";
  }
  return text;
}

InstructionCounts counted(int encode, int step) { return *read_counts(ran, callgrind(encode, step)); }
Json baseline() { return with_recorded(Json::object(), counted(45'000, 2'000'000)); }

TEST(InstructionCountsTest, ReadsEachWorkloadsCountPerStep) {
  const InstructionCounts counts = counted(45'310, 1'974'010);
  EXPECT_EQ(counts.built_with, "x86_64 GNU 12.2.0 -O2");
  ASSERT_EQ(counts.per_step.size(), 2u);
  EXPECT_EQ(counts.per_step[0].first, "codec/encode");
  EXPECT_DOUBLE_EQ(counts.per_step[0].second, 453.10);
  EXPECT_DOUBLE_EQ(counts.per_step[1].second, 19740.10);
}

TEST(InstructionCountsTest, PassesWithinThreePercentEitherWay) {
  EXPECT_TRUE(compare(counted(45'000, 2'000'000), baseline()).missed.empty());
  EXPECT_TRUE(compare(counted(46'300, 1'941'000), baseline()).missed.empty());
}

TEST(InstructionCountsTest, AnArtificialExtraCostFails) {
  const Verdict verdict = compare(counted(45'000, 2'064'000), baseline());
  ASSERT_EQ(verdict.missed.size(), 1u);
  EXPECT_EQ(verdict.missed[0],
            "control/step: 20,640 instructions per step, +3.20 % against the recorded 20,000: find out what costs "
            "more; if it must, record it with benchmarks/gate/run --record");
  EXPECT_EQ(verdict.table.rows.at(1).back(), "MISSED");
  EXPECT_EQ(verdict.table.rows.at(0).back(), "");
}

TEST(InstructionCountsTest, AGainIsToBeRecorded) {
  const Verdict verdict = compare(counted(40'000, 2'000'000), baseline());
  ASSERT_EQ(verdict.missed.size(), 1u);
  EXPECT_NE(verdict.missed[0].find("-11.11 %"), std::string::npos);
  EXPECT_NE(verdict.missed[0].find("better; record it"), std::string::npos);
}

TEST(InstructionCountsTest, AnotherCompilerHasNoBaselineAndIsToldHowToMakeOne) {
  InstructionCounts other = counted(45'000, 2'000'000);
  other.built_with = "aarch64 Clang 14";
  const Verdict verdict = compare(other, baseline());
  ASSERT_EQ(verdict.missed.size(), 1u);
  EXPECT_NE(verdict.missed[0].find("'aarch64 Clang 14'; there are those of 'x86_64 GNU 12.2.0 -O2'"),
            std::string::npos);
  EXPECT_NE(verdict.missed[0].find("benchmarks/gate/run --record"), std::string::npos);
  const Json both = with_recorded(baseline(), other);
  EXPECT_TRUE(compare(other, both).missed.empty());
  EXPECT_TRUE(compare(counted(45'000, 2'000'000), both).missed.empty());
}

TEST(InstructionCountsTest, AWorkloadThatComesOrGoesMustBeRecorded) {
  InstructionCounts counts = counted(45'000, 2'000'000);
  counts.per_step[0].first = "codec/new";
  const Verdict verdict = compare(counts, baseline());
  ASSERT_EQ(verdict.missed.size(), 2u);
  EXPECT_EQ(verdict.missed[0].find("codec/new: no instruction count"), 0u);
  EXPECT_EQ(verdict.missed[1].find("codec/encode: recorded, but"), 0u);
}

TEST(InstructionCountsTest, DumpsThatDoNotFitTheWorkloadsSayNothing) {
  EXPECT_FALSE(read_counts(ran, ""));
  EXPECT_FALSE(read_counts("", callgrind(1000, 1000)));
  EXPECT_FALSE(read_counts(ran + "one/more\n", callgrind(1000, 1000)));
  EXPECT_FALSE(read_counts("x\n100\nonly/one\n", callgrind(1000, 1000)));
  const auto none = read_counts(ran, callgrind(1000, 0));  // the function was not found
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("control/step"), std::string::npos);
}

TEST(InstructionCountsTest, TheRecordedFileIsOneOfThem) {
  const Json recorded = Json::parse(std::ifstream(ECITON_GATE_INSTRUCTIONS));
  ASSERT_FALSE(recorded.empty());
  for (const auto& [built_with, counts] : recorded.items()) {
    EXPECT_TRUE(counts.contains("control/step_in_hover")) << built_with;
    for (const auto& [name, count] : counts.items()) EXPECT_GT(count.get<double>(), 1) << name;
  }
}

}  // namespace
}  // namespace eciton::bench
