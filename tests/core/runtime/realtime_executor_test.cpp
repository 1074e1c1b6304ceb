// The real-time executor, without asserting how punctual a loaded machine is: due times and overruns add up
// to the elapsed time whatever the delays.
#include "core/runtime/realtime_executor.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <thread>

#include "core/base/wall_clock.hpp"
#include "core/bus/vendors/sim_network/sim_network.hpp"
#include "core/runtime/name_key.hpp"
#include "tests/core/runtime/fake_services.hpp"

namespace eciton::runtime {
namespace {

using bus::sim_network::Network;
using testing::FakeService;

class RealtimeExecutorTest : public ::testing::Test {
 protected:
  ~RealtimeExecutorTest() override {
    executor_.reset();
    outside_.reset();
    ring_.reset();
    Network::reset_all();
  }
  static bus::ParticipantConfig config(const std::string& name) {
    return {.vendor = "sim_network", .domain = 41, .name = name};
  }
  std::unique_ptr<bus::Participant> ring_ = std::make_unique<bus::Participant>(config("ring"));
  std::unique_ptr<bus::Participant> outside_ = std::make_unique<bus::Participant>(config("outside"));
  std::unique_ptr<RealtimeExecutor> executor_ = std::make_unique<RealtimeExecutor>(
      ExecutorConfig{.module_id = 3, .process = "test"}, std::vector<bus::Participant*>{ring_.get()});
  StopFlag stop_;
};

TEST_F(RealtimeExecutorTest, StepsAndOverrunsAddUpToTheElapsedPeriods) {
  constexpr Duration period = 5ms;
  int steps = 0;
  const Duration before = monotonic_now();
  Duration first{}, last{};
  FakeService service("service", every(period, Phase::control), [&](TimePoint) {
    last = monotonic_now();
    if (steps == 0) first = last;
    if (++steps == 30) stop_.request();
    if (steps == 10) std::this_thread::sleep_for(28ms);  // five periods late, at the least
  });
  executor_->add(service);
  executor_->run(stop_);
  const CycleStatistics& statistics = executor_->group().entries()[0]->statistics;
  EXPECT_EQ(statistics.cycles(), 30u);
  EXPECT_GE(statistics.overruns(), 4u);
  // The n-th step lies in its own period of the grid that began before the first.
  const auto periods = static_cast<std::int64_t>(statistics.cycles() + statistics.overruns());
  EXPECT_GE((last - before) / period + 1, periods);
  EXPECT_LE((last - first) / period, periods);
  EXPECT_GE(statistics.execution().max, 28ms);
}

TEST_F(RealtimeExecutorTest, GivesServicesTheWallClock) {
  TimePoint stepped;
  FakeService service("service", every(1ms, Phase::control), [&](TimePoint now) {
    stepped = now;
    stop_.request();
  });
  executor_->add(service);
  const TimePoint before = wall_now();
  executor_->run(stop_);
  EXPECT_GE(stepped, before);
  EXPECT_LE(stepped, wall_now());
}

TEST_F(RealtimeExecutorTest, StepsTriggeredServicesInTheOrderOfTheDataFlow) {
  testing::FakeEstimation estimation(*ring_, 3);
  testing::FakeControl control(*ring_, 3);
  executor_->add(control);
  executor_->add(estimation);
  auto imu = outside_->create_writer(topics::imu);
  auto rotors = outside_->create_reader(topics::rotor_command);
  std::thread loop([&] { executor_->run(stop_); });
  int answered = 0;
  for (int k = 0; k < 20; ++k) {
    const TimePoint now = wall_now();
    outside_->set_now(now);
    imu.write({.module_id = 3, .stamp_ns = to_ns(now)});
    const Duration until = monotonic_now() + 5s;
    while (rotors.trigger().newest_stamp() < now && monotonic_now() < until) {
      outside_->waker().wait(100ms);
      rotors.take();
    }
    answered += rotors.trigger().newest_stamp() >= now;
  }
  stop_.request();
  loop.join();
  EXPECT_EQ(answered, 20);
  EXPECT_EQ(executor_->group().entries()[0]->service->name(), "estimation");
}

TEST_F(RealtimeExecutorTest, TriggeredServiceStepsWithoutSamplesAfterItsTimeOut) {
  auto reader = ring_->create_reader(topics::imu);
  int steps = 0;
  FakeService service("service", on(reader, 3ms, Phase::control), [&](TimePoint) {
    if (++steps == 5) stop_.request();
  });
  executor_->add(service);
  const Duration before = monotonic_now();
  executor_->run(stop_);
  EXPECT_GE(monotonic_now() - before, 15ms);
  EXPECT_EQ(executor_->group().entries()[0]->statistics.timeouts(), 5u);
}

TEST_F(RealtimeExecutorTest, BeatsForEachServiceFromTheLoop) {
  auto beats = outside_->create_reader(topics::heartbeat);
  FakeService fast("fast", every(5ms, Phase::control)), slow("slow", every(10s, Phase::control));
  executor_->add(fast);
  executor_->add(slow);
  std::thread loop([&] { executor_->run(stop_); });
  std::optional<msg::Heartbeat> of_fast, of_slow;
  int beats_of_slow = 0;
  const Duration until = monotonic_now() + 10s;
  while (monotonic_now() < until && !(of_fast && of_fast->cycles >= 3 && beats_of_slow >= 3)) {
    outside_->waker().wait(100ms);
    outside_->set_now(wall_now());
    while (const auto beat = beats.take()) {
      (beat->value.service == "fast" ? of_fast : of_slow) = beat->value;
      beats_of_slow += beat->value.service == "slow";
    }
  }
  stop_.request();
  loop.join();
  ASSERT_TRUE(of_fast && of_slow);
  EXPECT_EQ(of_fast->module_id, 3u);
  EXPECT_EQ(of_fast->service_key, name_key("fast"));
  EXPECT_EQ(of_fast->pid, static_cast<std::uint32_t>(::getpid()));
  EXPECT_EQ(of_fast->vendor.view(), "sim_network");
  EXPECT_GT(of_fast->period_s, 0);
  EXPECT_EQ(of_slow->cycles, 1u) << "beats do not wait for steps";
  EXPECT_EQ(of_fast->lifecycle, msg::Lifecycle::active);
  int farewells = 0;
  for (const Duration end = monotonic_now() + 10s; monotonic_now() < end && farewells < 2;) {
    while (const auto beat = beats.take()) farewells += beat->value.lifecycle == msg::Lifecycle::finalized;
    if (farewells < 2) outside_->waker().wait(10ms);
  }
  EXPECT_EQ(farewells, 2) << "the last ones of an executor that was told to stop";
}

TEST_F(RealtimeExecutorTest, OneWakerServesTwoRings) {
  bus::Participant swarm({.vendor = "sim_network", .domain = 42, .name = "swarm"}, &ring_->waker());
  bus::Participant peer({.vendor = "sim_network", .domain = 42, .name = "peer"});
  auto beacons = swarm.create_reader(topics::beacon);
  auto beacon = peer.create_writer(topics::beacon);
  int samples = 0;
  FakeService radio("radio", on(beacons, 20s, Phase::coordinate), [&](TimePoint now) {
    EXPECT_EQ(swarm.now(), now) << "the step's time holds on every ring";
    while (beacons.take()) ++samples;
    if (samples > 0) stop_.request();
  });
  RealtimeExecutor executor({.process = "radio", .heartbeat_period = 0ms}, {ring_.get(), &swarm});
  executor.add(radio);
  std::thread sender([&] {
    std::this_thread::sleep_for(20ms);
    beacon.write({.module_id = 9, .stamp_ns = to_ns(wall_now())});
  });
  executor.run(stop_);
  sender.join();
  EXPECT_EQ(samples, 1);
}

TEST_F(RealtimeExecutorTest, StopsOnASignal) {
  FakeService service("service", every(10s, Phase::control));
  executor_->add(service);
  const StopOnSignals stops(stop_);
  std::thread killer([] {
    std::this_thread::sleep_for(10ms);
    ::kill(::getpid(), SIGTERM);
  });
  executor_->run(stop_);
  killer.join();
  EXPECT_TRUE(stop_.requested());
}

TEST_F(RealtimeExecutorTest, RunsOnWithoutRealtimeRightsAndNamesThem) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's shadow memory must not be locked";
#endif
  // No machine gives priority 1000.
  RealtimeExecutor executor({.process = "test", .realtime_priority = 1000}, {ring_.get()});
  FakeService service("service", every(1ms, Phase::control), [&](TimePoint) { stop_.request(); });
  executor.add(service);
  executor.run(stop_);
  ::munlockall();
  EXPECT_EQ(executor.group().entries()[0]->statistics.cycles(), 1u);
}

TEST_F(RealtimeExecutorTest, MutedReadersDoNotWakeButKeepTheirSamples) {
  auto reader = ring_->create_reader(topics::imu);
  auto writer = outside_->create_writer(topics::imu);
  ring_->set_all_wake(false);
  auto later = ring_->create_reader(topics::imu);
  writer.write({.module_id = 1, .stamp_ns = 1});
  EXPECT_FALSE(ring_->waker().wait(0ms));
  later.trigger().set_wakes(true);
  writer.write({.module_id = 1, .stamp_ns = 2});
  EXPECT_TRUE(ring_->waker().wait(1s));
  EXPECT_TRUE(reader.take());
}

}  // namespace
}  // namespace eciton::runtime
