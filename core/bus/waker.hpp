// Wakes one waiting thread from others: what a vendor's callback may do, and all it may do.
#pragma once

#include <atomic>
#include <cstdint>

#include "core/base/time.hpp"

namespace eciton::bus {

/// On a futex: a wake-up through an event descriptor and ppoll, which a timer descriptor beside it bounds, took
/// 14.0 µs in the median where this takes 11 and a condition variable 12 (one processor, SCHED_FIFO, 1 kHz,
/// 2026-11-22).
class Waker {
 public:
  Waker();
  ~Waker();
  Waker(const Waker&) = delete;
  Waker& operator=(const Waker&) = delete;

  /// Any thread, signal handlers too; real-time safe. Signals before a wait are kept.
  void signal() noexcept;
  /// Waits until a signal or the instant of the monotonic clock; true: signalled. One thread.
  bool wait_until(Duration monotonic) noexcept;
  /// The same for `timeout`.
  bool wait(Duration timeout) noexcept;
  /// For a poll of one's own: readable when signalled; call clear() before looking for work. Costs each signal a
  /// call of the system from then on.
  int file_descriptor();
  void clear() noexcept;

 private:
  enum State : std::uint32_t { idle, sleeping, signalled };

  void drain() noexcept;

  std::atomic<std::uint32_t> state_{idle};
  std::atomic<bool> polled_{false};
  int fd_;
};

}  // namespace eciton::bus
