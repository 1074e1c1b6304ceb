// The simulation executor: order, due times, triggers, failures, and the same bits for the same seed.
#include "core/runtime/sim_executor.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "core/bus/vendors/sim_network/sim_network.hpp"
#include "tests/core/runtime/fake_services.hpp"

namespace eciton::runtime {
namespace {

using bus::sim_network::Network;
using bus::sim_network::Pacing;
using testing::FakeService;

constexpr std::uint32_t domain = 40;
constexpr TimePoint t0 = from_ns(1'000'000'000'000);

struct CountingPlant final : Plant {
  void advance(TimePoint until) override { at = until; }
  TimePoint at = t0;
};

bus::ParticipantConfig on_sim_network(const std::string& name) {
  return {.vendor = "sim_network", .domain = domain, .name = name};
}

class SimExecutorTest : public ::testing::Test {
 protected:
  SimExecutorTest() { Network::of(domain).configure(1, Pacing::virtual_time); }
  ~SimExecutorTest() override {
    executor_.reset();
    participants_.clear();
    Network::reset_all();
  }

  bus::Participant& participant(const std::string& name) {
    participants_.push_back(std::make_unique<bus::Participant>(on_sim_network(name)));
    return *participants_.back();
  }
  SimModule& module(std::uint32_t id) {
    return executor_->add_module({.module_id = id, .process = "module"},
                                 {&participant("module " + std::to_string(id))});
  }
  /// Offsets from t0 at which a service of that schedule steps until `end`, in ms.
  std::vector<int> step_times_ms(Duration period, Duration end) {
    std::vector<int> times;
    FakeService service("steps", every(period, Phase::control),
                        [&](TimePoint now) { times.push_back(static_cast<int>((now - t0) / 1ms)); });
    SimModule& m = module(1);
    m.add(service);
    executor_->run_until(t0 + end);
    m.remove(service);
    return times;
  }

  CountingPlant plant_;
  std::unique_ptr<SimExecutor> executor_ = std::make_unique<SimExecutor>(
      SimConfig{.start = t0, .tick = 2ms}, plant_, [](TimePoint t) { Network::of(domain).advance(t); });
  std::vector<std::unique_ptr<bus::Participant>> participants_;
};

TEST_F(SimExecutorTest, StepsByPhaseThenModuleThenAddition) {
  std::string order;
  const auto service = [&](const char* name, Phase phase) {
    return FakeService(name, every(2ms, phase), [&order, name](TimePoint) { order += std::string(name) + " "; });
  };
  FakeService control1 = service("c1", Phase::control), estimate1 = service("e1", Phase::estimate);
  FakeService late1 = service("l1", Phase::control), act1 = service("a1", Phase::act),
              sense1 = service("s1", Phase::sense);
  FakeService control2 = service("c2", Phase::control), estimate2 = service("e2", Phase::estimate);
  SimModule& one = module(1);
  SimModule& two = module(2);
  two.add(control2);
  for (FakeService* each : {&act1, &control1, &late1, &estimate1, &sense1}) one.add(*each);
  two.add(estimate2);
  executor_->tick();
  EXPECT_EQ(order, "s1 e1 e2 c1 l1 c2 a1 ");
}

TEST_F(SimExecutorTest, WorldAndObserversSeeTheTickInTheirTurn) {
  std::vector<std::string> seen;
  FakeService service("service", every(2ms, Phase::act), [&](TimePoint now) {
    EXPECT_EQ(plant_.at, now) << "the world moves on after the services";
    seen.push_back("step");
  });
  module(1).add(service);
  executor_->observe([&](TimePoint now) {
    EXPECT_EQ(plant_.at, now);
    seen.push_back("observe");
  });
  executor_->run_until(t0 + 4ms);
  EXPECT_EQ(seen, (std::vector<std::string>{"step", "observe", "step", "observe"}));
  EXPECT_EQ(plant_.at, t0 + 4ms);
  EXPECT_EQ(executor_->ticks(), 2u);
}

TEST_F(SimExecutorTest, KeepsTheMeanOfAPeriodThatIsNoWholeNumberOfTicks) {
  EXPECT_EQ(step_times_ms(5ms, 24ms), (std::vector<int>{0, 6, 10, 16, 20}));
}

TEST_F(SimExecutorTest, StepsOncePerTickAtTheMost) {
  EXPECT_EQ(step_times_ms(1ms, 8ms), (std::vector<int>{0, 2, 4, 6}));
}

TEST_F(SimExecutorTest, ChainOfTriggersStepsWithinOneTick) {
  bus::Participant& ring = participant("ring");
  bus::Participant& outside = participant("outside");
  testing::FakeEstimation estimation(ring, 1);
  testing::FakeControl control(ring, 1);
  auto imu = outside.create_writer(topics::imu);
  auto rotors = outside.create_reader(topics::rotor_command);
  SimModule& m = executor_->add_module({.module_id = 1}, {&ring});
  m.add(control);
  m.add(estimation);
  for (int k = 0; k < 5; ++k) {
    const TimePoint now = executor_->now();
    imu.write({.module_id = 1, .stamp_ns = to_ns(now)});
    outside.set_now(now);
    executor_->tick();
    const auto command = rotors.take_newest();
    ASSERT_TRUE(command);
    EXPECT_EQ(command->value.stamp_ns, to_ns(now));
  }
  EXPECT_EQ(estimation.steps, 5);
  EXPECT_EQ(control.steps, 5);
}

TEST_F(SimExecutorTest, TriggeredServiceStepsOnItsOwnModulesSamplesAndOnTimeOut) {
  bus::Participant& ring = participant("ring");
  bus::Participant& outside = participant("outside");
  testing::FakeControl control(ring, 1);  // at most 50 ms
  SimModule& m = executor_->add_module({.module_id = 1}, {&ring});
  m.add(control);
  auto state = outside.create_writer(topics::module_state);
  executor_->run_until(t0 + 100ms);
  EXPECT_EQ(control.steps, 1) << "by time-out at 50 ms only";
  state.write({.module_id = 2, .stamp_ns = to_ns(executor_->now())});
  executor_->tick();
  EXPECT_EQ(control.steps, 2) << "the time-out of 100 ms";
  state.write({.module_id = 2, .stamp_ns = to_ns(executor_->now())});
  executor_->tick();
  EXPECT_EQ(control.steps, 2) << "a peer's state is no trigger";
  EXPECT_LT(control.newest_state(), t0) << "nor is it news";
  state.write({.module_id = 1, .stamp_ns = to_ns(executor_->now())});
  executor_->tick();
  EXPECT_EQ(control.steps, 3);
  EXPECT_EQ(m.group().entries()[0]->statistics.timeouts(), 2u);
}

TEST_F(SimExecutorTest, DoesNotStepAgainForSamplesLeftInTheTrigger) {
  bus::Participant& ring = participant("ring");
  bus::Participant& outside = participant("outside");
  auto reader = ring.create_reader(topics::module_state);
  int steps = 0;
  FakeService lazy("lazy", on(reader, 1s, Phase::control), [&](TimePoint) { ++steps; });
  executor_->add_module({.module_id = 1}, {&ring}).add(lazy);
  auto state = outside.create_writer(topics::module_state);
  state.write({.module_id = 1, .stamp_ns = to_ns(t0)});
  executor_->run_until(t0 + 20ms);
  EXPECT_EQ(steps, 1);
}

TEST_F(SimExecutorTest, RunsUntilAPredicateHoldsOrALimitPasses) {
  int steps = 0;
  FakeService service("service", every(2ms, Phase::act), [&](TimePoint) { ++steps; });
  module(1).add(service);
  EXPECT_TRUE(executor_->run_until([&] { return steps == 3; }, t0 + 1s));
  EXPECT_EQ(executor_->now(), t0 + 6ms);
  EXPECT_FALSE(executor_->run_until([] { return false; }, t0 + 20ms));
  EXPECT_EQ(executor_->now(), t0 + 20ms);
}

TEST_F(SimExecutorTest, ClockOfAModuleRunsBesideTheWorlds) {
  TimePoint stepped;
  FakeService service("service", every(2ms, Phase::act), [&](TimePoint now) { stepped = now; });
  SimModule& m = module(1);
  m.add(service);
  m.set_clock(30ms);
  executor_->tick();
  EXPECT_EQ(stepped, t0 + 30ms);
  m.set_clock(-1s, 50'000);  // 50 ppm over 1000.002 s
  executor_->tick();
  EXPECT_EQ(stepped, t0 + 2ms - 1s + 50'000'100ns);
}

TEST_F(SimExecutorTest, AServiceAddedOrRemovedDuringTheRunStartsOrStopsThere) {
  int steps = 0;
  FakeService service("service", every(2ms, Phase::act), [&](TimePoint) { ++steps; });
  SimModule& m = module(1);
  executor_->run_until(t0 + 1s);
  m.add(service);
  executor_->run_until(t0 + 1s + 10ms);
  EXPECT_EQ(steps, 5);
  EXPECT_EQ(m.group().entries()[0]->statistics.overruns(), 0u) << "time before it was there is not missed";
  m.remove(service);
  executor_->run_until(t0 + 2s);
  EXPECT_EQ(steps, 5);
}

TEST_F(SimExecutorTest, SuspendedServiceNeitherStepsNorBeats) {
  bus::Participant& outside = participant("outside");
  auto beats = outside.create_reader(topics::heartbeat);
  int steps = 0;
  FakeService hangs("hangs", every(2ms, Phase::act), [&](TimePoint) { ++steps; });
  FakeService lives("lives", every(2ms, Phase::act));
  SimModule& m = module(1);
  m.add(hangs);
  m.add(lives);
  executor_->run_until(t0 + 100ms);
  m.suspend(hangs, true);
  while (beats.take()) {
  }
  executor_->run_until(t0 + 200ms);
  EXPECT_EQ(steps, 50);
  while (const auto beat = beats.take()) EXPECT_EQ(beat->value.service.view(), "lives");
  m.suspend(hangs, false);
  executor_->run_until(t0 + 300ms);
  EXPECT_EQ(steps, 100);
  EXPECT_EQ(m.group().entries()[0]->statistics.overruns(), 50u);
}

TEST_F(SimExecutorTest, BeatsEveryTenMillisecondsWithNothingOfTheWallClock) {
  bus::Participant& outside = participant("outside");
  auto beats = outside.create_reader(topics::heartbeat);
  FakeService service("service", every(2ms, Phase::act));
  module(7).add(service);
  std::vector<msg::Heartbeat> heard;
  executor_->observe([&](TimePoint now) {
    outside.set_now(now);
    while (const auto beat = beats.take()) heard.push_back(beat->value);
  });
  executor_->run_until(t0 + 1s);
  ASSERT_EQ(heard.size(), 100u);
  const msg::Heartbeat& last = heard.back();
  EXPECT_EQ(last.stamp_ns, to_ns(t0 + 990ms));
  EXPECT_EQ(last.module_id, 7u);
  EXPECT_EQ(last.service.view(), "service");
  EXPECT_EQ(last.vendor.view(), "sim_network");
  EXPECT_EQ(last.lifecycle, msg::Lifecycle::active);
  EXPECT_EQ(last.cycles, 496u);
  EXPECT_EQ(last.pid, 0u);
  EXPECT_DOUBLE_EQ(last.period_s, 2e-3);
  EXPECT_EQ(last.execution_s_max, 0);
}

TEST_F(SimExecutorTest, RefusesASecondServiceOfOneNameAndASenselessSchedule) {
  FakeService one("control", every(2ms, Phase::act)), same("control", every(2ms, Phase::act));
  FakeService still("still", every(0ms, Phase::act)), nameless("", every(2ms, Phase::act));
  SimModule& m = module(1);
  m.add(one);
  for (FakeService* wrong : {&same, &still, &nameless}) EXPECT_THROW(m.add(*wrong), BadInput);
  EXPECT_EQ(m.group().entries().size(), 1u);
}

/// Everything that crosses a bad network between two modules, as bytes.
std::vector<std::uint8_t> recorded_run(std::uint64_t seed) {
  Network& network = Network::of(domain);
  network.configure(seed, Pacing::virtual_time);
  network.set_default_link({.delay = 3ms, .jitter = 2ms, .loss = 0.2, .duplication = 0.1, .reordering = 0.1});
  std::vector<std::uint8_t> record;
  {
    bus::Participant one(on_sim_network("one")), two(on_sim_network("two")), ear(on_sim_network("ear"));
    auto states = ear.create_raw_reader(bus::info(topics::module_state));
    auto beats = ear.create_raw_reader(bus::info(topics::heartbeat));
    auto imu = ear.create_writer(topics::imu);
    testing::FakeEstimation first(one, 1), second(two, 2);
    CountingPlant plant;
    SimExecutor executor({.start = t0}, plant, [&](TimePoint t) { network.advance(t); });
    executor.add_module({.module_id = 1}, {&one}).add(first);
    executor.add_module({.module_id = 2}, {&two}).add(second);
    executor.observe([&](TimePoint now) {
      for (const std::uint32_t id : {1u, 2u}) imu.write({.module_id = id, .stamp_ns = to_ns(now)});
      const auto keep = [](void* context, std::span<const std::uint8_t> cdr) {
        auto& bytes = *static_cast<std::vector<std::uint8_t>*>(context);
        bytes.insert(bytes.end(), cdr.begin(), cdr.end());
      };
      states.take(keep, &record);
      beats.take(keep, &record);
    });
    executor.run_until(t0 + 2s);
  }
  Network::reset_all();
  return record;
}

TEST(SimDeterminismTest, TheSameSeedGivesTheSameBitsAndAnotherDoesNot) {
  const auto first = recorded_run(11);
  EXPECT_GT(first.size(), 50'000u);
  EXPECT_EQ(first, recorded_run(11));
  EXPECT_NE(first, recorded_run(12));
}

}  // namespace
}  // namespace eciton::runtime
