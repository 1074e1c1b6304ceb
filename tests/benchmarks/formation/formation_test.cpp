// A short run over real processes and loopback: it ends, and its figures hang together. No time is asserted.
#include "benchmarks/formation/formation.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

#include "deploy/net/net.hpp"

namespace eciton::bench {
namespace {

class FormationTest : public testing::Test {
 protected:
  void SetUp() override {
    directory_ = "/tmp/bench-formation-" + std::to_string(::getpid());
    ::setenv("ECITON_RUNTIME_DIR", directory_.c_str(), 1);
    options_.hosts = false;
    options_.losses = {0};
    options_.modules = {2};
    options_.pairs = {{"cyclonedds", "fastdds"}};
    options_.trials = options_.sessions = 2;
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  std::string directory_;
  FormationOptions options_;
  runtime::StopFlag stop_;
  Progress progress_;
};

TEST_F(FormationTest, FormsAChainAcrossVendorsAndTellsWhenAllMembersHadIt) {
  const Result result = run_formation(options_, stop_, progress_);
  for (const std::string& note : result.notes) std::printf("%s\n", note.c_str());
  ASSERT_FALSE(result.partial);
  ASSERT_EQ(result.samples.size(), 3u);
  const Samples &view = result.samples[0], &wrench = result.samples[1], &skew = result.samples[2];
  EXPECT_EQ(view.name, "view.2.0.cyclonedds+fastdds");
  ASSERT_EQ(view.values.size() + view.lost, 2u);
  for (std::size_t k = 0; k < view.values.size(); ++k) {
    EXPECT_GT(view.values[k], 0);
    EXPECT_LT(view.values[k], wrench.values[k]);  // a wrench is shared by those who fly the view
    EXPECT_LE(skew.values[k], view.values[k]);
  }
}

TEST_F(FormationTest, CountsTheBytesOfDiscoveryInHosts) {
  if (!net::check_rights()) GTEST_SKIP() << "no right to make network namespaces";
  options_.hosts = true;
  options_.net = "benchtest" + std::to_string(::getpid() % 10000);
  options_.form = false;
  options_.discovery_modules = {2};
  options_.discovery_vendors = {"cyclonedds"};
  options_.settle_s = options_.joining_s = 2;
  options_.idle_s = 3;
  const Result result = run_formation(options_, stop_, progress_);
  for (const std::string& note : result.notes) std::printf("%s\n", note.c_str());
  EXPECT_FALSE(result.partial);
  EXPECT_GT(result.metrics["discovery_joining_bytes.lean.cyclonedds.2"], 0);
  EXPECT_GT(result.metrics["discovery_joining_bytes.default.cyclonedds.2"], 0);
  EXPECT_EQ(result.metrics["multicast_idle_packets.lean.cyclonedds.2"], 0);
}

TEST_F(FormationTest, WhatCannotBeMeasuredIsBadInputBeforeAnythingStarts) {
  const auto says = [&](const char* what) {
    try {
      run_formation(options_, stop_, progress_);
      ADD_FAILURE() << what;
    } catch (const BadInput& bad) {
      EXPECT_NE(bad.error.message.find(what), std::string::npos) << bad.error.message;
    }
  };
  options_.losses = {0.2};
  says("over loopback");
  options_.losses = {1.5};
  says("expected 0 to below 1");
  options_.losses = {0};
  options_.modules = {9};
  says("expected 2 to 8");
  options_.modules = {2};
  options_.pairs = {{"cyclonedds", "opendds"}};
  says("opendds");
  EXPECT_FALSE(std::filesystem::exists(directory_));
}

}  // namespace
}  // namespace eciton::bench
