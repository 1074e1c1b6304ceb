// One thread is woken by others, neither too late nor by a signal that was spent.
#include "core/bus/waker.hpp"

#include <gtest/gtest.h>
#include <poll.h>

#include <thread>

#include "core/base/wall_clock.hpp"

namespace eciton::bus {
namespace {

bool is_readable(int descriptor) {
  pollfd one{descriptor, POLLIN, 0};
  return ::poll(&one, 1, 0) == 1;
}

TEST(WakerTest, KeepsASignalThatCameBeforeTheWaitOnce) {
  Waker waker;
  waker.signal();
  waker.signal();
  EXPECT_TRUE(waker.wait(60s));
  EXPECT_FALSE(waker.wait(Duration::zero()));
}

TEST(WakerTest, EndsAtTheInstantWithoutASignal) {
  Waker waker;
  const Duration until = monotonic_now() + 5ms;
  EXPECT_FALSE(waker.wait_until(until));
  EXPECT_GE(monotonic_now(), until);
  EXPECT_FALSE(waker.wait_until(Duration{-1}));
  EXPECT_FALSE(waker.wait(-1s));
}

TEST(WakerTest, WakesASleeperEachTime) {
  constexpr int rounds = 2000;
  Waker there, back;
  std::thread other([&] {
    for (int k = 0; k < rounds; ++k) {
      if (!there.wait(60s)) return;
      back.signal();
    }
  });
  for (int k = 0; k < rounds; ++k) {
    there.signal();
    ASSERT_TRUE(back.wait(60s)) << "round " << k;
  }
  other.join();
}

TEST(WakerTest, LosesNoWorkWhenSignalsRaceWithTheWait) {
  constexpr int items = 50'000;
  Waker waker;
  std::atomic<int> made{0};
  std::thread maker([&] {
    for (int k = 0; k < items; ++k) {
      made.fetch_add(1);
      waker.signal();
    }
  });
  int seen = 0;
  while (seen < items) {
    ASSERT_TRUE(waker.wait(60s)) << seen;
    seen = made.load();
  }
  maker.join();
}

TEST(WakerTest, ItsDescriptorIsReadableWhileASignalIsThere) {
  Waker waker;
  waker.signal();  // before anyone asked for the descriptor
  const int descriptor = waker.file_descriptor();
  EXPECT_TRUE(is_readable(descriptor));
  waker.clear();
  EXPECT_FALSE(is_readable(descriptor));
  waker.signal();
  EXPECT_TRUE(is_readable(waker.file_descriptor()));
  EXPECT_TRUE(waker.wait(60s));  // takes it there too
  EXPECT_FALSE(is_readable(descriptor));
}

}  // namespace
}  // namespace eciton::bus
