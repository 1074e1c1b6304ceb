// Memory first: a page fault costs more than a late wake-up.
#include "core/runtime/realtime_thread.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <array>
#include <cstring>

namespace eciton::runtime {

namespace {

[[gnu::noinline]] void prefault_stack() {
  std::array<unsigned char, 256 * 1024> stack;
  for (std::size_t k = 0; k < stack.size(); k += 4096) *static_cast<volatile unsigned char*>(&stack[k]) = 0;
}

}  // namespace

std::optional<std::string> make_realtime(int priority) {
  std::string missing;
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) missing = "CAP_IPC_LOCK (memory stays pageable)";
  prefault_stack();
  // SCHED_RESET_ON_FORK: what the process starts later is not real-time by accident.
  const sched_param parameters{.sched_priority = priority};
  if (const int error = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters);
      error != 0) {
    if (!missing.empty()) missing += " and ";
    missing += error == EPERM ? "CAP_SYS_NICE (no SCHED_FIFO)"
                              : "a priority from 1 to 99, not " + std::to_string(priority) + " (no SCHED_FIFO)";
  }
  if (missing.empty()) return std::nullopt;
  return "not real-time: missing " + missing + "; under systemd give it by AmbientCapabilities=";
}

}  // namespace eciton::runtime
