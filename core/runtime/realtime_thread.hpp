// Makes the calling thread a real-time one, as far as the process may.
#pragma once

#include <optional>
#include <string>

namespace eciton::runtime {

/// Locks the process's memory, prefaults the stack and takes SCHED_FIFO at `priority` (1 to 99); threads made
/// later do not inherit it. Returns what is missing, for one warning: the right and how to give it.
std::optional<std::string> make_realtime(int priority);

}  // namespace eciton::runtime
