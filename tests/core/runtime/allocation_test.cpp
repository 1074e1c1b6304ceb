// The loops of all three executors leave the heap alone once they run.
#include <gtest/gtest.h>

#include <thread>

#include "core/base/wall_clock.hpp"
#include "core/bus/vendors/sim_network/sim_network.hpp"
#include "core/runtime/checkpoint.hpp"
#include "core/runtime/lockstep_executor.hpp"
#include "core/runtime/lockstep_master.hpp"
#include "core/runtime/realtime_executor.hpp"
#include "core/runtime/sim_executor.hpp"
#include "tests/allocation_guard/allocation_guard.hpp"
#include "tests/core/runtime/fake_services.hpp"

namespace eciton::runtime {
namespace {

using bus::sim_network::Network;
using eciton::testing::AllocationGuard;
using testing::FakeService;

constexpr std::uint32_t domain = 46;

bus::ParticipantConfig on_sim_network(const char* name) {
  return {.vendor = "sim_network", .domain = domain, .name = name};
}

/// A service that guards the thread which steps it, from its `begin`-th step to its `end`-th.
class Guarded {
 public:
  Guarded(int begin, int end, std::function<void()> at_end) : begin_(begin), end_(end), at_end_(std::move(at_end)) {}

  void step() {
    ++steps_;
    if (steps_ == begin_) guard_.emplace();
    if (steps_ != end_) return;
    uses_ = guard_->framework() + guard_->vendor();
    if (uses_ > 0) first_ = guard_->describe();
    guard_.reset();
    at_end_();
  }
  void expect_none() const {
    EXPECT_GE(steps_, end_);
    EXPECT_EQ(uses_, 0u) << first_;
  }

 private:
  int begin_, end_;
  std::function<void()> at_end_;
  int steps_ = 0;
  std::optional<AllocationGuard> guard_;
  std::uint64_t uses_ = 0;
  std::string first_;
};

class ExecutorAllocationTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!AllocationGuard::available()) GTEST_SKIP() << "the sanitizer has a heap of its own";
  }
  void TearDown() override { Network::reset_all(); }
};

TEST_F(ExecutorAllocationTest, RealtimeLoop) {
  bus::Participant ring(on_sim_network("ring"));
  StopFlag stop;
  Guarded guarded(10, 100, [&] { stop.request(); });
  FakeService pacemaker("pacemaker", every(1ms, Phase::sense), [&](TimePoint now) {
    guarded.step();
    static_cast<void>(now);
  });
  auto imu = ring.create_writer(topics::imu);
  FakeService sensor("sensor", every(2ms, Phase::sense),
                     [&](TimePoint now) { imu.write({.module_id = 1, .stamp_ns = to_ns(now)}); });
  testing::FakeEstimation estimation(ring, 1);
  testing::FakeControl control(ring, 1);
  RealtimeExecutor executor({.module_id = 1}, {&ring});
  for (Service* service : {static_cast<Service*>(&pacemaker), static_cast<Service*>(&sensor),
                           static_cast<Service*>(&estimation), static_cast<Service*>(&control)}) {
    executor.add(*service);
  }
  executor.run(stop);
  guarded.expect_none();
  EXPECT_GT(control.steps, 5);
}

TEST_F(ExecutorAllocationTest, LockstepLoop) {
  StopFlag stop;
  bus::Participant ring(on_sim_network("ring"));
  Guarded guarded(20, 200, [] {});
  FakeService service("service", every(2ms, Phase::control), [&](TimePoint) { guarded.step(); });
  LockstepExecutor executor({.module_id = 1, .process = "process"}, {&ring});
  executor.add(service);
  std::thread master_thread([&] {
    bus::Participant host(on_sim_network("host"));
    LockstepMaster master(host, {"process"}, stop);
    for (std::uint64_t k = 0; k < 250; ++k) {
      master.publish(k, from_ns(static_cast<std::int64_t>(k) * 2'000'000), false);
      EXPECT_TRUE(master.wait_for_acks(20s));
    }
    stop.request();
  });
  executor.run(stop);
  master_thread.join();
  guarded.expect_none();
}

TEST_F(ExecutorAllocationTest, SimulationTick) {
  struct Still final : Plant {
    void advance(TimePoint) override {}
  } plant;
  Network& network = Network::of(domain);
  network.configure(1, bus::sim_network::Pacing::virtual_time);
  {
    bus::Participant ring(on_sim_network("ring"));
    testing::FakeEstimation estimation(ring, 1);
    testing::FakeControl control(ring, 1);
    SimExecutor executor({}, plant, [&](TimePoint t) { network.advance(t); });
    SimModule& module = executor.add_module({.module_id = 1}, {&ring});
    module.add(estimation);
    module.add(control);
    executor.run_until(from_ns(0) + 100ms);
    AllocationGuard guard;
    executor.run_until(from_ns(0) + 1s);
    EXPECT_EQ(guard.framework(), 0u) << guard.describe();
  }
}

TEST_F(ExecutorAllocationTest, PuttingACheckpoint) {
  struct Keeper final : Service {
    std::string_view name() const override { return "keeper"; }
    Schedule schedule() override { return every(std::chrono::milliseconds(10), Phase::coordinate); }
    void step(TimePoint) noexcept override {}
    std::uint32_t state_version() const noexcept override { return 1; }
    void save_state(StateWriter& writer) const noexcept override { writer(values); }
    std::array<double, 20> values{};
  } keeper;
  const auto file = std::filesystem::temp_directory_path() / ("eciton-put-" + std::to_string(::getpid()));
  {
    Checkpoint checkpoint(keeper, file);
    checkpoint.start();
    AllocationGuard guard;
    for (int k = 0; k < 1000; ++k) checkpoint.save();
    EXPECT_EQ(guard.framework(), 0u) << guard.describe();
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace eciton::runtime
