// How a process is told to end: a flag that also wakes whoever sleeps, set by SIGINT, SIGTERM or another thread.
#pragma once

#include <csignal>

#include <array>
#include <atomic>

#include "core/bus/waker.hpp"

namespace eciton::runtime {

class StopFlag {
 public:
  StopFlag();
  ~StopFlag();
  StopFlag(const StopFlag&) = delete;
  StopFlag& operator=(const StopFlag&) = delete;

  /// Any thread, signal handlers too.
  void request() noexcept;
  bool requested() const noexcept { return requested_.load(std::memory_order_acquire); }
  /// Readable from the request on: for polls beside a waker's.
  int file_descriptor() const { return fd_; }

  /// The request signals this waker too, until it is taken back; at most eight at a time.
  void also_wake(bus::Waker& waker) const;
  /// After it returns the waker may be destroyed.
  void no_longer_wake(bus::Waker& waker) const noexcept;

 private:
  std::atomic<bool> requested_{false};
  std::atomic<int> requesting_{0};
  int fd_;
  mutable std::array<std::atomic<bus::Waker*>, 8> wakers_{};
};

/// While it lives, SIGINT and SIGTERM set the flag; a second one of a kind ends the process as it would without
/// us. One per process.
class StopOnSignals {
 public:
  explicit StopOnSignals(StopFlag& flag);
  ~StopOnSignals();
  StopOnSignals(const StopOnSignals&) = delete;
  StopOnSignals& operator=(const StopOnSignals&) = delete;

 private:
  std::array<struct sigaction, 2> before_{};
};

}  // namespace eciton::runtime
