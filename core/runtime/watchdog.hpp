// Tells whoever supervises this process that its loop runs, and goes on running: by systemd's notify protocol, which
// systemd and `eciton up` both understand.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <thread>

#include "core/base/time.hpp"

namespace eciton::runtime {

/// Counts the turns of a loop, for another thread that looks whether it still turns.
class LoopProgress {
 public:
  /// The loop's thread; real-time safe.
  void turn() noexcept { turns_.store(turns_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed); }
  /// One other thread: whether it has turned since the last note.
  bool has_turned() const noexcept { return turns_.load(std::memory_order_relaxed) != noted_; }
  void note() noexcept { noted_ = turns_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> turns_{0};
  std::uint64_t noted_ = 0;
};

/// Sends READY=1 once the loop works, WATCHDOG=1 for as long as it does, and STOPPING=1 at its end: where
/// NOTIFY_SOCKET is set, and the second only where WATCHDOG_USEC asks for it, several times within it. From a thread
/// of its own, not a real-time one unless its maker is: if the process is stopped or its loop hangs, nothing is sent.
class Watchdog {
 public:
  /// The name of something that has not worked since this last found nothing; empty: all has. Called from the
  /// watchdog's thread, and no more once the destructor has returned.
  using FindIdle = std::function<std::string_view()>;

  explicit Watchdog(FindIdle find_idle);
  /// Waits a bounded time for what is being sent.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  struct Shared;

  std::shared_ptr<Shared> shared_;  // with the thread, which a supervisor that does not read may hold up
  std::thread thread_;
};

}  // namespace eciton::runtime
