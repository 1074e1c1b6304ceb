// Repeats a participant's announcement after its start, and shortly after another one was discovered.
//
// With static peers the next one by itself comes after half a minute, and a radio loses packets.
// Fast DDS 2.9 announces itself some instants before it listens, and a participant that hears of it answers once and
// at once: that answer may be lost, and the next comes with the periodic announcement (measured with six processes on
// a busy machine: one start in ten had a pair that met 1 s late). So whoever discovers a Fast DDS participant says
// its own name again a little later.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace eciton::bus::vendors {

/// A thread that calls `announce` a few times in the three seconds after `started`, and within half a second after
/// `discovered`.
class Reannouncer {
 public:
  explicit Reannouncer(std::function<void()> announce);
  ~Reannouncer();
  Reannouncer(const Reannouncer&) = delete;
  Reannouncer& operator=(const Reannouncer&) = delete;

  void started();
  /// From a vendor's thread.
  void discovered();
  /// No announcement after it returns.
  void stop();

 private:
  void run();
  void repeat(std::size_t times);

  std::function<void()> announce_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::chrono::steady_clock::time_point since_{};
  std::size_t announced_ = 0, times_ = 0;
  bool stop_ = false;
  std::thread thread_;  // last: uses all of the above
};

}  // namespace eciton::bus::vendors
