// The waker, which the stop flag signals too.
#include "core/runtime/sleeper.hpp"

#include <ctime>

#include "core/base/wall_clock.hpp"

namespace eciton::runtime {

Sleeper::Sleeper(bus::Waker& waker, const StopFlag& stop) : waker_(waker), stop_(stop) { stop_.also_wake(waker_); }

Sleeper::~Sleeper() { stop_.no_longer_wake(waker_); }

void Sleeper::until(Duration monotonic) noexcept {
  if (!stop_.requested()) waker_.wait_until(monotonic);
}

void Sleeper::until_undisturbed(Duration monotonic) noexcept {
  const timespec at = to_timespec(monotonic);
  if (!stop_.requested()) ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

bool Sleeper::for_at_most(Duration timeout) noexcept {
  return !stop_.requested() && waker_.wait_until(monotonic_now() + timeout) && !stop_.requested();
}

}  // namespace eciton::runtime
