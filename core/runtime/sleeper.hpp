// Where an executor's thread sleeps: until a time of the monotonic clock, a signal of its waker, or the end.
#pragma once

#include "core/bus/waker.hpp"
#include "core/runtime/stop_signal.hpp"

namespace eciton::runtime {

class Sleeper {
 public:
  Sleeper(bus::Waker& waker, const StopFlag& stop);
  ~Sleeper();
  Sleeper(const Sleeper&) = delete;
  Sleeper& operator=(const Sleeper&) = delete;

  /// Absolute, so that delays do not add up. Returns early on a wake or stop; look for work after it. Real-time safe.
  void until(Duration monotonic) noexcept;
  /// As `until`, but deaf to the waker: one call of the system instead of two.
  void until_undisturbed(Duration monotonic) noexcept;
  /// For waits where being a little late does not matter. True: woken.
  bool for_at_most(Duration timeout) noexcept;

  bool stopped() const noexcept { return stop_.requested(); }

 private:
  bus::Waker& waker_;
  const StopFlag& stop_;
};

}  // namespace eciton::runtime
