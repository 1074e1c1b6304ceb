// No step of any service touches the heap, apart, docking or in a chain; nor do the hardware host, the executor
// or the bus below them.
#include <gtest/gtest.h>

#include "tests/allocation_guard/allocation_guard.hpp"
#include "tests/scenario/fleet.hpp"

namespace eciton::deploy {
namespace {

/// Flies on without an operator, whose work is not real time.
void expect_no_allocation(Simulation& simulation, double duration_s, const char* when) {
  const TimePoint until = simulation.now() + from_s(duration_s);
  testing::AllocationGuard guard;
  simulation.executor().run_until(until);
  EXPECT_EQ(guard.framework(), 0u) << when << "\n" << guard.describe();
}

TEST(StepAllocationTest, NoServiceUsesTheHeapInFlight) {
  if (!testing::AllocationGuard::available()) GTEST_SKIP() << "a sanitizer brings its own heap";
  Simulation simulation(row_of(2, 11));
  Pilot pilot(simulation);
  pilot.bring_to_hover(heights(2));
  expect_no_allocation(simulation, 1, "hovering");
  const std::uint64_t goal = pilot.op().dock(2, 1);
  pilot.wait_until([&] { return pilot.op().report(goal)->progress == GoalProgress::accepted; }, 5);
  expect_no_allocation(simulation, 8, "docking, latching and agreeing on the chain");
  EXPECT_EQ(simulation.world().latched_links(), 1);
  pilot.wait(0.2);
  const std::vector<double> bent{0, 0, 0.2, 0};
  pilot.follow(pilot.op().morph(1, bent, 0), 0.6);
  expect_no_allocation(simulation, 2, "morphing as a chain");
}

}  // namespace
}  // namespace eciton::deploy
