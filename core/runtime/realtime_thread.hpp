// Makes the calling thread a real-time one, as far as the process may.
#pragma once

#include <optional>
#include <string>

namespace eciton::runtime {

/// Locks the process's memory, prefaults the stack and takes SCHED_FIFO at `priority` (1 to 99); threads made
/// later do not inherit it. Returns what is missing, for one warning: the right and how to give it.
std::optional<std::string> make_realtime(int priority);

/// While it lives, what threads the calling one makes are real-time as well: a vendor's, through which every sample
/// comes. Without the right they stay as they are; make_realtime says so later.
class RealtimeForNewThreads {
 public:
  /// 0: changes nothing.
  explicit RealtimeForNewThreads(int priority);
  ~RealtimeForNewThreads();
  RealtimeForNewThreads(const RealtimeForNewThreads&) = delete;
  RealtimeForNewThreads& operator=(const RealtimeForNewThreads&) = delete;

 private:
  bool changed_;
};

}  // namespace eciton::runtime
