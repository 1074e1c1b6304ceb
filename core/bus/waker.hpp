// Wakes one waiting thread from others: what a vendor's callback may do, and all it may do.
#pragma once

#include <atomic>

#include "core/base/time.hpp"

namespace eciton::bus {

class Waker {
 public:
  Waker();
  ~Waker();
  Waker(const Waker&) = delete;
  Waker& operator=(const Waker&) = delete;

  /// Any thread, real-time safe; signals before a wait are kept.
  void signal() noexcept;
  /// Waits until a signal or for `timeout`; true: signalled. One thread.
  bool wait(Duration timeout) noexcept;
  /// For a poll of one's own: readable when signalled; call clear() before looking for work.
  int file_descriptor() const { return fd_; }
  void clear() noexcept;

 private:
  int fd_;
  std::atomic<bool> signalled_{false};
};

}  // namespace eciton::bus
