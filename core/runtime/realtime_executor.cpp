// Sleep, step what is due in the order of phases, beat.
#include "core/runtime/realtime_executor.hpp"

#include "core/base/log.hpp"
#include "core/base/wall_clock.hpp"
#include "core/runtime/realtime_thread.hpp"

namespace eciton::runtime {

void RealtimeExecutor::run(const StopFlag& stop) {
  if (group_.config().realtime_priority > 0) {
    if (const auto missing = make_realtime(group_.config().realtime_priority)) {
      spdlog::warn("{}: {}", group_.config().process, *missing);
    }
  }
  group_.mute();
  group_.wake_by_triggers();
  Sleeper sleeper(group_.waker(), stop);
  // Periods alone need no waker; heartbeats then bound how late a stop is seen.
  const bool listens = group_.has_triggers() || group_.config().heartbeat_period <= Duration::zero();
  group_.start(monotonic_now());
  while (!stop.requested()) {
    step_what_is_due();
    listens ? sleeper.until(group_.next_due()) : sleeper.until_undisturbed(group_.next_due());
  }
  group_.say_farewell(wall_now());
}

void RealtimeExecutor::step_what_is_due() noexcept {
  Pace at = monotonic_now();
  for (const auto& entry : group_.entries()) {
    if (group_.due(*entry, at)) at = group_.step(*entry, at, wall_now());
  }
  group_.beat_if_due(at, wall_now());
}

}  // namespace eciton::runtime
