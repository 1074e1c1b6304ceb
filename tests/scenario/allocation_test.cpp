// No step of any service touches the heap, apart, docking or in a chain; nor do the hardware host, the executor
// or the bus below them.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>

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

/// What must not pass.
class WastefulService final : public runtime::Service {
 public:
  std::string_view name() const override { return "wasteful"; }
  runtime::Schedule schedule() override { return runtime::every(from_s(0.01), runtime::Phase::coordinate); }
  void step(TimePoint now) noexcept override {
    kept_ = std::vector<double>(1 + static_cast<std::size_t>(to_ns(now) % 7));
  }

 private:
  std::vector<double> kept_;
};

TEST(StepAllocationTest, AServiceThatUsesTheHeapIsCaught) {
  if (!testing::AllocationGuard::available()) GTEST_SKIP() << "a sanitizer brings its own heap";
  Simulation simulation(row_of(1, 11));
  WastefulService wasteful;
  simulation.executor()
      .add_module({.module_id = 1, .process = "wasteful", .heartbeat_period = Duration::zero()},
                  {&simulation.listener(0)})
      .add(wasteful);
  simulation.executor().run_until(simulation.now() + from_s(0.1));
  testing::AllocationGuard guard;
  simulation.executor().run_until(simulation.now() + from_s(0.2));
  EXPECT_GT(guard.framework(), 0u);
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

TEST(StepAllocationTest, NeitherDoesAFaultThatIsRecorded) {
  if (!testing::AllocationGuard::available()) GTEST_SKIP() << "a sanitizer brings its own heap";
  std::string scratch = (std::filesystem::temp_directory_path() / "eciton-faults-XXXXXX").string();
  ASSERT_NE(::mkdtemp(scratch.data()), nullptr);
  {
    SimulationConfig config = row_of(1, 11);
    config.module.recorder.directory = scratch;
    Simulation simulation(config);
    Pilot pilot(simulation);
    pilot.bring_to_hover(heights(1));
    expect_no_allocation(simulation, 1, "hovering");
    simulation.suspend(0, "estimation");
    expect_no_allocation(simulation, 2, "losing its state, with the hardware host's safe output after it");
  }
  const auto files = std::distance(std::filesystem::directory_iterator(scratch + "/m1"), {});
  EXPECT_EQ(files, 2) << "of control and of the hardware host";
  std::filesystem::remove_all(scratch);
}

}  // namespace
}  // namespace eciton::deploy
