// A request reaches whoever sleeps, and nobody who has gone.
#include "core/runtime/stop_signal.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "core/base/wall_clock.hpp"
#include "core/runtime/sleeper.hpp"

namespace eciton::runtime {
namespace {

using namespace std::chrono_literals;

TEST(StopFlagTest, EndsASleepOfAnyLength) {
  StopFlag stop;
  bus::Waker waker;
  Sleeper sleeper(waker, stop);
  std::thread other([&] {
    std::this_thread::sleep_for(2ms);
    stop.request();
  });
  sleeper.until(monotonic_now() + 1h);
  other.join();
  EXPECT_TRUE(stop.requested());
}

// Under the sanitizers: a request that is still under way when its sleeper has seen it and is gone.
TEST(StopFlagTest, TouchesNoWakerThatIsGone) {
  for (int round = 0; round < 300; ++round) {
    StopFlag stop;
    std::thread sleeping([&] {
      const auto waker = std::make_unique<bus::Waker>();
      Sleeper sleeper(*waker, stop);
      while (!stop.requested()) sleeper.until(monotonic_now() + 100us);
    });
    if (round % 2 == 0) std::this_thread::sleep_for(std::chrono::microseconds(round));
    stop.request();
    sleeping.join();
  }
}

}  // namespace
}  // namespace eciton::runtime
