// Due times to the nanosecond, with the instants given by hand.
#include "core/runtime/service_group.hpp"

#include <gtest/gtest.h>

#include "core/base/contract.hpp"
#include "core/bus/vendors/sim_network/sim_network.hpp"
#include "tests/core/runtime/fake_services.hpp"

namespace eciton::runtime {
namespace {

using testing::FakeService;
using GroupPacing = ServiceGroup::Pacing;

constexpr TimePoint now{};

class ServiceGroupTest : public ::testing::Test {
 protected:
  ~ServiceGroupTest() override {
    ring_.reset();
    bus::sim_network::Network::reset_all();
  }
  std::unique_ptr<bus::Participant> ring_ = std::make_unique<bus::Participant>(
      bus::ParticipantConfig{.vendor = "sim_network", .domain = 47, .name = "ring"});
};

TEST_F(ServiceGroupTest, SkipsWholePeriodsAndKeepsTheGrid) {
  ServiceGroup group({.heartbeat_period = 0ms}, {ring_.get()}, GroupPacing::wall_clock);
  FakeService service("service", every(10ms, Phase::control));
  auto& entry = group.add(service);
  group.start(1000ms);
  EXPECT_FALSE(group.due(entry, 999ms));
  ASSERT_TRUE(group.due(entry, 1000ms));
  group.step(entry, 1000ms, now);
  EXPECT_EQ(group.next_due(), 1010ms);
  group.step(entry, 1019ms, now);  // late, but within its period
  EXPECT_EQ(entry.statistics.overruns(), 0u);
  EXPECT_EQ(group.next_due(), 1020ms);
  group.step(entry, 1047ms, now);  // those of 1030 and 1040 are gone
  EXPECT_EQ(entry.statistics.overruns(), 2u);
  EXPECT_EQ(group.next_due(), 1050ms);
}

TEST_F(ServiceGroupTest, OnTheWallClockASampleThatIsALittleLateIsNotPrecededByATimeOut) {
  for (const auto& [pacing, after_sample] : {std::pair{GroupPacing::wall_clock, 2500us},
                                             {GroupPacing::lockstep, 2000us},
                                             {GroupPacing::simulated, 2000us}}) {
    bus::Reader<msg::Imu> reader = ring_->create_reader(topics::imu);
    bus::Writer<msg::Imu> writer = ring_->create_writer(topics::imu);
    ServiceGroup group({.heartbeat_period = 0ms}, {ring_.get()}, pacing);
    FakeService service("service", on(reader, 2ms, Phase::control), [&](TimePoint) {
      while (reader.take()) {
      }
    });
    auto& entry = group.add(service);
    group.start(0ms);
    EXPECT_EQ(group.next_due(), 2ms);
    writer.write({.module_id = 1, .stamp_ns = 1});
    ASSERT_TRUE(group.due(entry, 1ms));
    group.step(entry, 1ms, now);
    EXPECT_EQ(group.next_due(), 1ms + after_sample);
    EXPECT_FALSE(group.due(entry, 1ms + after_sample - 1ns));
    ASSERT_TRUE(group.due(entry, 1ms + after_sample));
    group.step(entry, 1ms + after_sample, now);
    EXPECT_EQ(group.next_due(), 3ms + after_sample) << "without samples it keeps its own pace";
    EXPECT_EQ(entry.statistics.timeouts(), 1u);
  }
}

TEST_F(ServiceGroupTest, FindsAServiceThatHasNotSteppedSinceAllHad) {
  ServiceGroup group({.heartbeat_period = 0ms}, {ring_.get()}, GroupPacing::wall_clock);
  FakeService first("first", every(10ms, Phase::sense)), second("second", every(10ms, Phase::control));
  auto& a = group.add(first);
  auto& b = group.add(second);
  EXPECT_EQ(group.find_idle(), "first");
  group.step(a, 0ms, now);
  EXPECT_EQ(group.find_idle(), "second");
  group.step(b, 0ms, now);
  EXPECT_EQ(group.find_idle(), "") << "one after the other counts";
  EXPECT_EQ(group.find_idle(), "first");
}

TEST_F(ServiceGroupTest, SaysWhoseWakersDiffer) {
  static int violations = 0;
  violations = 0;
  const ViolationHandler before = set_violation_handler([](const Violation&) noexcept { ++violations; });
  bus::Participant sharing({.vendor = "sim_network", .domain = 48, .name = "sharing"}, &ring_->waker());
  bus::Participant alone({.vendor = "sim_network", .domain = 48, .name = "alone"});
  const ServiceGroup good({}, {ring_.get(), &sharing}, GroupPacing::wall_clock);
  EXPECT_EQ(violations, 0);
  const ServiceGroup bad({}, {ring_.get(), &alone}, GroupPacing::wall_clock);
  EXPECT_EQ(violations, 1);
  set_violation_handler(before);
}

TEST_F(ServiceGroupTest, NeedsAParticipant) { EXPECT_THROW(ServiceGroup({}, {}, GroupPacing::wall_clock), BadInput); }

}  // namespace
}  // namespace eciton::runtime
