// Memory first: a page fault costs more than a late wake-up.
#include "core/runtime/realtime_thread.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <array>
#include <cerrno>

namespace eciton::runtime {

namespace {

[[gnu::noinline]] void prefault_stack() {
  std::array<unsigned char, 256 * 1024> stack;
  for (std::size_t k = 0; k < stack.size(); k += 4096) *static_cast<volatile unsigned char*>(&stack[k]) = 0;
}

}  // namespace

std::optional<std::string> make_realtime(int priority) {
  std::string missing;
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) missing = "memory stays pageable without CAP_IPC_LOCK";
  prefault_stack();
  // SCHED_RESET_ON_FORK: what the process starts later is not real-time by accident.
  const sched_param parameters{.sched_priority = priority};
  const int error = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters);
  if (error != 0) {
    if (!missing.empty()) missing += ", ";
    missing += error == EPERM ? "no SCHED_FIFO without CAP_SYS_NICE (under systemd: AmbientCapabilities=)"
                              : "no SCHED_FIFO at priority " + std::to_string(priority) + ": 1 to 99 would be right";
  }
  return missing.empty() ? std::nullopt : std::optional("not real-time: " + missing);
}

RealtimeForNewThreads::RealtimeForNewThreads(int priority) {
  const sched_param parameters{.sched_priority = priority};
  changed_ = priority > 0 && ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters) == 0;
}

RealtimeForNewThreads::~RealtimeForNewThreads() {
  const sched_param parameters{.sched_priority = 0};
  if (changed_) ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &parameters);
}

}  // namespace eciton::runtime
