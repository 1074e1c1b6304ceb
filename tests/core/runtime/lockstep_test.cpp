// Lockstep between a master and executors in threads: the data flow within a tick, who is waited for, and
// what happens to lost samples, repeated ticks and a process that hangs.
#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "core/base/wall_clock.hpp"
#include "core/bus/vendors/sim_network/sim_network.hpp"
#include "core/runtime/lockstep_executor.hpp"
#include "core/runtime/lockstep_master.hpp"
#include "core/runtime/name_key.hpp"
#include "tests/core/runtime/fake_services.hpp"

namespace eciton::runtime {
namespace {

using testing::FakeService;

constexpr TimePoint t0 = from_ns(5'000'000'000);
constexpr Duration tick_length = 2ms;
constexpr TimePoint time_of(std::uint64_t tick) { return t0 + static_cast<std::int64_t>(tick) * tick_length; }

struct Ring {
  std::string vendor = "sim_network";
  std::uint32_t domain = 43;
  bus::ParticipantConfig config(const std::string& name) const {
    return {.vendor = vendor, .domain = domain, .name = name};
  }
};

/// A process of the module, as a thread; its participant and executor belong to that thread.
class Process {
 public:
  /// `compose` adds the services, which it keeps alive as its result.
  template <class Compose>
  Process(const Ring& ring, const std::string& name, Compose compose, Duration sample_wait = 5s) {
    std::promise<void> ready;
    auto is_ready = ready.get_future();
    thread_ = std::thread([this, ring, name, compose, sample_wait, &ready] {
      bus::Participant participant(ring.config(name));
      LockstepExecutor executor({.module_id = 1, .process = name}, {&participant}, sample_wait);
      const auto services = compose(participant, executor);
      ready.set_value();
      executor.run(stop_);
      counts_ = executor.counts();
    });
    is_ready.wait();
  }
  ~Process() { end(); }
  Process(const Process&) = delete;

  LockstepExecutor::Counts end() {
    stop_.request();
    if (thread_.joinable()) thread_.join();
    return counts_;
  }

 private:
  StopFlag stop_;
  LockstepExecutor::Counts counts_;
  std::thread thread_;
};

template <class Service>
auto only(std::atomic<int>& steps_at_end) {
  return [&steps_at_end](bus::Participant& participant, LockstepExecutor& executor) {
    struct Kept {
      Kept(bus::Participant& ring, std::atomic<int>& sink) : service(ring, 1), steps(sink) {}
      ~Kept() { steps = service.steps; }
      Service service;
      std::atomic<int>& steps;
    };
    auto kept = std::make_unique<Kept>(participant, steps_at_end);
    executor.add(kept->service);
    return kept;
  };
}

/// A periodic service that counts its steps, and may take its time.
auto periodic(Duration period, std::atomic<int>& steps, std::function<void(TimePoint)> body = {}) {
  return [period, &steps, body](bus::Participant&, LockstepExecutor& executor) {
    auto service =
        std::make_unique<FakeService>("periodic", every(period, Phase::coordinate), [&steps, body](TimePoint now) {
          if (body) body(now);
          ++steps;
        });
    executor.add(*service);
    return service;
  };
}

class Host {
 public:
  Host(const Ring& ring, const std::vector<std::string>& processes, Duration publish_again_after = 100ms)
      : participant_(ring.config("host")),
        master(participant_, processes, stop, publish_again_after),
        imu(participant_.create_writer(topics::imu)),
        rotors(participant_.create_reader(topics::rotor_command)) {}

  /// One tick; an error names who did not answer.
  Status tick(std::uint64_t number, bool sampled, Duration timeout = 20s) {
    const TimePoint now = time_of(number);
    participant_.set_now(now);
    if (sampled) imu.write({.module_id = 1, .stamp_ns = to_ns(now)});
    master.publish(number, now, sampled);
    return master.wait_for_acks(timeout);
  }

 private:
  bus::Participant participant_;

 public:
  StopFlag stop;
  LockstepMaster master;
  bus::Writer<msg::Imu> imu;
  bus::Reader<msg::RotorCommand> rotors;
};

std::string text(const Status& status) { return status ? "" : status.error().message; }

class LockstepTest : public ::testing::Test {
 protected:
  ~LockstepTest() override { bus::sim_network::Network::reset_all(); }
  Ring ring_;
  std::atomic<int> steps_{0};
};

TEST_F(LockstepTest, CommandOfATickComesFromTheSampleOfThatTick) {
  std::atomic<int> estimation_steps{0}, control_steps{0};
  Process control(ring_, "control-1", only<testing::FakeControl>(control_steps));
  Process estimation(ring_, "estimation-1", only<testing::FakeEstimation>(estimation_steps));
  Host host(ring_, {"estimation-1", "control-1"});
  ASSERT_EQ(text(host.tick(0, false)), "");
  for (std::uint64_t k = 1; k <= 300; ++k) {
    ASSERT_EQ(text(host.tick(k, true)), "");
    const auto command = host.rotors.take_newest();
    ASSERT_TRUE(command) << "tick " << k;
    ASSERT_EQ(command->value.stamp_ns, to_ns(time_of(k)));
  }
  const auto counts = estimation.end();
  control.end();
  EXPECT_EQ(counts.ticks, 301u);
  EXPECT_EQ(counts.unsampled, 0u);
  EXPECT_EQ(host.master.stale_inputs(), 0u);
  EXPECT_EQ(estimation_steps, 300);
  EXPECT_EQ(control_steps, 300);
}

TEST_F(LockstepTest, TicksWithoutASampleWaitForNone) {
  Process estimation(ring_, "estimation-1", only<testing::FakeEstimation>(steps_), 100s);
  Host host(ring_, {"estimation-1"});
  for (std::uint64_t k = 0; k < 100; ++k) ASSERT_EQ(text(host.tick(k, k % 5 == 4)), "");
  estimation.end();
  EXPECT_EQ(steps_, 20);
}

TEST_F(LockstepTest, AMissingSampleIsWaitedForOnceAndHeardAgainLater) {
  Process estimation(ring_, "estimation-1", only<testing::FakeEstimation>(steps_), 30ms);
  Host host(ring_, {"estimation-1"});
  ASSERT_EQ(text(host.tick(0, true)), "");
  const auto tick_without_sample = [&](std::uint64_t k) {
    host.master.publish(k, time_of(k), true);
    return host.master.wait_for_acks(20s);
  };
  for (std::uint64_t k = 1; k <= 10; ++k) ASSERT_EQ(text(tick_without_sample(k)), "");
  for (std::uint64_t k = 11; k <= 20; ++k) ASSERT_EQ(text(host.tick(k, true)), "");
  EXPECT_EQ(host.master.stale_inputs(), 1u) << "of the step that gave up waiting";
  ASSERT_EQ(text(tick_without_sample(21)), "");
  const auto counts = estimation.end();
  EXPECT_EQ(counts.unsampled, 2u);
  EXPECT_EQ(steps_, 1 + 1 + 10 + 1);
}

TEST_F(LockstepTest, AProcessIsNotWaitedForBeforeItsNextTick) {
  Process slow(ring_, "slow", periodic(10ms, steps_));
  Host host(ring_, {"slow"});
  bus::Participant ear(ring_.config("ear"));
  auto acks = ear.create_reader(topics::clock_ack);
  std::vector<std::pair<std::uint64_t, std::uint64_t>> heard;
  for (std::uint64_t k = 0; k <= 50; ++k) {
    ASSERT_EQ(text(host.tick(k, false)), "");
    while (const auto ack = acks.take()) heard.emplace_back(ack->value.tick, ack->value.next_tick);
  }
  slow.end();
  EXPECT_EQ(steps_, 11) << "at 0, 10, ..., 100 ms";
  ASSERT_GE(heard.size(), 12u);
  // Before two ticks are known, neither is the tick's length.
  EXPECT_EQ(heard[0], (std::pair<std::uint64_t, std::uint64_t>{0, 1}));
  EXPECT_EQ(heard[1], (std::pair<std::uint64_t, std::uint64_t>{1, 5}));
  EXPECT_EQ(heard[2], (std::pair<std::uint64_t, std::uint64_t>{5, 10}));
  EXPECT_EQ(heard.back(), (std::pair<std::uint64_t, std::uint64_t>{50, 55}));
}

TEST_F(LockstepTest, TicksMayJumpWhereNothingFallsDue) {
  Process slow(ring_, "slow", periodic(10ms, steps_));
  Host host(ring_, {"slow"});
  for (const std::uint64_t k : {0, 1, 5, 10, 15, 20}) ASSERT_EQ(text(host.tick(k, false)), "");
  slow.end();
  EXPECT_EQ(steps_, 5);
}

TEST_F(LockstepTest, AStallNamesTheCulpritAndWhatItDidLast) {
  std::promise<void> release;
  auto released = release.get_future().share();
  Process good(ring_, "control-1", periodic(2ms, steps_));
  std::atomic<int> bad_steps{0};
  Process bad(ring_, "docking-1", periodic(2ms, bad_steps, [&, released](TimePoint now) {
                if (now == time_of(3)) released.wait();
              }));
  Host host(ring_, {"control-1", "docking-1", "joints-1"});
  host.master.publish(0, t0, false);
  const std::string never = text(host.master.wait_for_acks(200ms));
  EXPECT_NE(never.find("joints-1 (never heard)"), std::string::npos) << never;
  EXPECT_EQ(never.find("control-1"), std::string::npos) << never;

  std::atomic<int> joint_steps{0};
  Process joints(ring_, "joints-1", periodic(2ms, joint_steps));
  for (std::uint64_t k = 0; k < 3; ++k) ASSERT_EQ(text(host.tick(k, false)), "") << k;
  const std::string stalled = text(host.tick(3, false, 200ms));
  EXPECT_NE(stalled.find("tick 3"), std::string::npos) << stalled;
  EXPECT_NE(stalled.find("docking-1 (its last: tick 2)"), std::string::npos) << stalled;
  EXPECT_EQ(stalled.find("control-1"), std::string::npos) << stalled;
  release.set_value();
  EXPECT_EQ(text(host.master.wait_for_acks(20s)), "") << "it goes on once the culprit does";
}

TEST_F(LockstepTest, ARepeatedTickIsAcknowledgedAgainButNotSteppedAgain) {
  Process process(ring_, "process", periodic(2ms, steps_));
  Host host(ring_, {"process"});
  ASSERT_EQ(text(host.tick(0, false)), "");
  ASSERT_EQ(text(host.tick(1, false)), "");
  bus::Participant ear(ring_.config("ear"));
  auto acks = ear.create_reader(topics::clock_ack);
  host.master.publish(1, time_of(1), false);
  std::optional<bus::Sample<msg::ClockAck>> again;
  for (int k = 0; k < 100 && !again; ++k) {
    ear.waker().wait(100ms);
    again = acks.take();
  }
  ASSERT_TRUE(again);
  EXPECT_EQ(again->value.tick, 1u);
  EXPECT_EQ(process.end().repeated, 1u);
  EXPECT_EQ(steps_, 2);
}

TEST_F(LockstepTest, AProcessThatComesLateOrAnewIsReachedByARepeatedTick) {
  Host host(ring_, {"process"}, 10ms);
  auto first = std::async(std::launch::async, [&] { return text(host.tick(0, false)); });
  auto process = std::make_unique<Process>(ring_, "process", periodic(2ms, steps_));
  EXPECT_EQ(first.get(), "");
  EXPECT_EQ(text(host.tick(1, false)), "");
  process.reset();
  auto second = std::async(std::launch::async, [&] { return text(host.tick(2, false)); });
  Process anew(ring_, "process", periodic(2ms, steps_));
  EXPECT_EQ(second.get(), "");
  EXPECT_EQ(text(host.tick(3, false)), "");
}

TEST_F(LockstepTest, AStopEndsTheMastersWait) {
  Host host(ring_, {"nobody"});
  host.stop.request();
  EXPECT_NE(text(host.tick(0, false, 1000s)).find("nobody"), std::string::npos);
}

TEST_F(LockstepTest, BeatsInTheWorldsTime) {
  Process process(ring_, "process", periodic(4ms, steps_));
  Host host(ring_, {"process"});
  bus::Participant ear(ring_.config("ear"));
  auto beats = ear.create_reader(topics::heartbeat);
  for (std::uint64_t k = 0; k <= 50; ++k) ASSERT_EQ(text(host.tick(k, false)), "");
  ear.set_now(time_of(50));
  const auto beat = beats.take_newest();
  ASSERT_TRUE(beat) << beats.statistics().received << " " << beats.statistics().dropped();
  EXPECT_EQ(beat->value.stamp_ns, to_ns(time_of(50)));
  EXPECT_DOUBLE_EQ(beat->value.period_s, 4e-3);
}

TEST_F(LockstepTest, RefusesTwoProcessesOfOneName) {
  EXPECT_THROW(Host(ring_, {"control-1", "control-1"}), BadInput);
}

/// The vendors: "a+b" has the host on a and the processes on b.
class LockstepOverVendorsTest : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(LockstepOverVendorsTest, CommandOfATickComesFromTheSampleOfThatTick) {
  const auto [host_vendor, process_vendor] = GetParam();
  const Ring ring{process_vendor, 44};
  std::atomic<int> estimation_steps{0}, control_steps{0}, periodic_steps{0};
  Process control(ring, "control-1", only<testing::FakeControl>(control_steps), 2s);
  Process estimation(ring, "estimation-1", only<testing::FakeEstimation>(estimation_steps), 2s);
  Process slow(ring, "docking-1", periodic(10ms, periodic_steps));
  Host host({host_vendor, 44}, {"estimation-1", "control-1", "docking-1"});
  ASSERT_EQ(text(host.tick(0, false)), "");
  // Best-effort samples may be lost until every reader has matched.
  std::uint64_t commanded = 0, late = 0;
  const Duration before = monotonic_now();
  for (std::uint64_t k = 1; k <= 500; ++k) {
    ASSERT_EQ(text(host.tick(k, true)), "");
    const auto command = host.rotors.take_newest();
    commanded += command.has_value();
    late += !command || command->value.stamp_ns != to_ns(time_of(k));
  }
  RecordProperty("ticks_per_second", static_cast<int>(500 / to_s(monotonic_now() - before)));
  EXPECT_GE(commanded, 480u);
  EXPECT_LE(late, 20u);
  EXPECT_EQ(periodic_steps, 101);
}

INSTANTIATE_TEST_SUITE_P(Vendors, LockstepOverVendorsTest,
                         ::testing::Values(std::pair{"cyclonedds", "cyclonedds"}, std::pair{"fastdds", "fastdds"},
                                           std::pair{"fastdds", "cyclonedds"}));

}  // namespace
}  // namespace eciton::runtime
