// An address that goes and comes: on an interface of a network namespace of the test's own, where that may be made.
#include "core/runtime/interface_watch.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <cstdlib>
#include <functional>
#include <thread>

#include "core/base/wall_clock.hpp"

namespace eciton::runtime {
namespace {

using namespace std::chrono_literals;

void shell(const char* command) { EXPECT_EQ(std::system(command), 0) << command; }

bool requested_within(const StopFlag& stop, Duration patience) {
  const Duration end = monotonic_now() + patience;
  while (!stop.requested() && monotonic_now() < end) std::this_thread::sleep_for(5ms);
  return stop.requested();
}

/// In a namespace where nothing is up yet; false where the process may not make one.
bool in_a_net_of_its_own(const std::function<void()>& body) {
  bool made = false;
  std::thread([&] {
    made = ::unshare(CLONE_NEWNET) == 0;
    if (made) body();
  }).join();
  return made;
}

TEST(InterfaceWatchTest, ReadsTheLoopbacksAddressAndNobodysOfWhatIsNotThere) {
  EXPECT_EQ(address_of("lo"), "127.0.0.1");
  EXPECT_EQ(address_of("eciton_none0"), std::nullopt);
}

TEST(InterfaceWatchTest, RequestsTheEndWhenTheAddressIsAnotherOneAndNotBefore) {
  const bool made = in_a_net_of_its_own([] {
    shell("ip link set lo up && ip address add 10.98.0.1/24 dev lo && ip address del 127.0.0.1/8 dev lo");
    StopFlag stop;
    const InterfaceWatch watch("lo", stop, 10ms);
    EXPECT_FALSE(requested_within(stop, 100ms));
    shell("ip address del 10.98.0.1/24 dev lo");
    EXPECT_FALSE(requested_within(stop, 100ms)) << "without an address there is nothing to start anew with";
    shell("ip address add 10.98.0.7/24 dev lo");
    EXPECT_TRUE(requested_within(stop, 2s));
  });
  if (!made) GTEST_SKIP() << "network namespaces cannot be made here";
}

TEST(InterfaceWatchTest, AnAddressThatWasAwayIsANewOne) {
  const bool made = in_a_net_of_its_own([] {
    shell("ip link set lo up");
    StopFlag stop;
    const InterfaceWatch watch("lo", stop, 10ms);
    shell("ip address del 127.0.0.1/8 dev lo");
    EXPECT_FALSE(requested_within(stop, 100ms));
    shell("ip address add 127.0.0.1/8 dev lo");
    EXPECT_TRUE(requested_within(stop, 2s));
  });
  if (!made) GTEST_SKIP() << "network namespaces cannot be made here";
}

}  // namespace
}  // namespace eciton::runtime
