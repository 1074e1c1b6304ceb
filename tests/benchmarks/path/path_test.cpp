// A short run over real processes: it ends, and its figures hang together. No time is asserted.
#include "benchmarks/path/path.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "benchmarks/statistics/summary.hpp"

namespace eciton::bench {
namespace {

class PathTest : public testing::Test {
 protected:
  void SetUp() override {
    directory_ = "/tmp/bench-path-" + std::to_string(::getpid());
    ::setenv("ECITON_RUNTIME_DIR", directory_.c_str(), 1);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  std::string directory_;
  runtime::StopFlag stop_;
  Progress progress_;
};

const Samples* find(const Result& result, const std::string& name) {
  for (const Samples& samples : result.samples) {
    if (samples.name == name) return &samples;
  }
  return nullptr;
}

TEST_F(PathTest, FliesTheRealProcessesAndSplitsTheTotalIntoItsStages) {
  PathOptions options;
  options.seconds = 1;
  options.layouts = {"services", "one-process"};
  const Result result = run_path(options, stop_, progress_);
  for (const std::string& note : result.notes) std::printf("%s\n", note.c_str());
  ASSERT_FALSE(result.partial);
  const Samples* total = find(result, "imu_to_rotors.services.cyclonedds");
  ASSERT_NE(total, nullptr);
  ASSERT_GT(total->values.size(), 100u);
  const Samples* first = find(result, "imu_to_estimation.services.cyclonedds");
  const Samples* second = find(result, "estimation_to_control.services.cyclonedds");
  const Samples* third = find(result, "control_to_rotors.services.cyclonedds");
  ASSERT_TRUE(first != nullptr && second != nullptr && third != nullptr);
  for (std::size_t k = 0; k < total->values.size(); ++k) {
    EXPECT_NEAR(first->values[k] + second->values[k] + third->values[k], total->values[k], 1e-6);
    EXPECT_GT(first->values[k], 0);
    EXPECT_GT(third->values[k], 0);
  }
  const Samples* inside = find(result, "inside.one-process.cyclonedds");
  const Samples* around = find(result, "imu_to_rotors.one-process.cyclonedds");
  ASSERT_TRUE(inside != nullptr && around != nullptr);
  EXPECT_LE(summarize(*inside).p50, summarize(*around).p50);
}

TEST_F(PathTest, ALayoutOrVendorOrProgramThatIsNotThereIsBadInputBeforeAnythingStarts) {
  PathOptions options;
  options.layouts = {"scattered"};
  EXPECT_THROW(run_path(options, stop_, progress_), BadInput);
  options = {};
  options.vendors = {"opendds"};
  EXPECT_THROW(run_path(options, stop_, progress_), BadInput);
  options = {};
  options.programs = "/nonexistent";
  EXPECT_THROW(run_path(options, stop_, progress_), BadInput);
  EXPECT_FALSE(std::filesystem::exists(directory_));
}

TEST_F(PathTest, WhatIsInterruptedIsPartialAndEndsAtOnce) {
  stop_.request();
  const Result result = run_path({}, stop_, progress_);
  EXPECT_TRUE(result.partial);
}

}  // namespace
}  // namespace eciton::bench
