// The step path of the network (write, take, advance) leaves the heap alone, with every fault at work.
#include "tests/allocation_guard/allocation_guard.hpp"

#include "tests/core/bus/sim_network/endpoints.hpp"

namespace eciton::bus::sim_network::testing {
namespace {

using eciton::testing::AllocationGuard;

TEST_F(VirtualNetwork, WriteTakeAndAdvanceLeaveTheHeapAlone) {
  if (!AllocationGuard::available()) GTEST_SKIP() << "the sanitizers bring a heap of their own";
  network().set_default_link(
      {.delay = 5ms, .jitter = 5ms, .loss = 0.3, .duplication = 0.1, .reordering = 0.1, .hold = 20ms});
  TestParticipant a("a"), b("b"), c("c");
  TestWriter sensor(a, keyed_type(), best_effort, "sensor"), state(a, keyed_type(), transient_local, "state");
  TestReader sensor_b(b, keyed_type(), best_effort, {}, "sensor"),
      sensor_c(c, keyed_type(), best_effort, {}, "sensor");
  TestReader state_b(b, keyed_type(), transient_local, {}, "state");
  std::uint64_t taken = 0;
  AllocationGuard guard;
  for (std::uint32_t k = 0; k < 5000; ++k) {
    advance(k * 1ms);
    sensor.write(k, k % 10);  // two keys over the reader's bound
    state.write(k, k % 10);
    for (TestReader* reader : {&sensor_b, &sensor_c, &state_b}) taken += reader->take_sum().first;
  }
  const std::uint64_t allocations = guard.framework();
  EXPECT_EQ(allocations, 0u) << guard.describe();
  EXPECT_GT(taken, 5000u);
  const Statistics count = network().statistics();
  for (const std::uint64_t each :
       {count.lost, count.retransmitted, count.superseded, count.duplicated, count.reordered, count.dropped})
    EXPECT_GT(each, 0u);
}

}  // namespace
}  // namespace eciton::bus::sim_network::testing
