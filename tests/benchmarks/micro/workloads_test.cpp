// Every workload does what its name says, over and over; the hot ones leave the heap alone.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "benchmarks/micro/workload.hpp"
#include "tests/allocation_guard/allocation_guard.hpp"

namespace eciton::bench {
namespace {

class WorkloadsTest : public ::testing::Test {
 protected:
  void SetUp() override { find_mirror_plugin(); }
};

TEST_F(WorkloadsTest, EachHasANameOfItsOwn) {
  std::set<std::string> names;
  for (const Workload& workload : all_workloads()) EXPECT_TRUE(names.insert(workload.name).second) << workload.name;
  EXPECT_GT(names.size(), 50u);
}

TEST_F(WorkloadsTest, TheHotOnesSucceedAndLeaveTheHeapAlone) {
  int hot = 0;
  for (const Workload& workload : all_workloads()) {
    if (!workload.hot) continue;
    ++hot;
    const Step step = workload.make();
    for (int k = 0; k < 50; ++k) {
      const double outcome = step();
      EXPECT_TRUE(std::isfinite(outcome)) << workload.name;
      // -1: not encoded, not delivered, no view.
      const bool delivers = workload.name.find("control/") != 0 && workload.name.find("contact_wrench/") != 0;
      if (delivers && workload.name.find("estimation/") != 0) {
        EXPECT_GE(outcome, 0) << workload.name;
      }
    }
    if (!testing::AllocationGuard::available()) continue;
    testing::AllocationGuard guard;
    double sum = 0;
    for (int k = 0; k < 50; ++k) sum += step();
    const auto uses = guard.framework() + guard.vendor();
    EXPECT_EQ(uses, 0u) << workload.name << ": " << guard.describe();
    EXPECT_TRUE(std::isfinite(sum));
  }
  EXPECT_GE(hot, 25);
}

TEST_F(WorkloadsTest, AChangedClaimChangesTheViewEachTime) {
  for (const Workload& workload : chain_workloads()) {
    const Step step = workload.make();
    const double first = step(), second = step();
    EXPECT_EQ(first != second, workload.name.find("view_join") != std::string::npos) << workload.name;
  }
}

}  // namespace
}  // namespace eciton::bench
