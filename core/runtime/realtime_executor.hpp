// The executor of the robot: wall clock, absolute sleeps, one real-time thread for a process's services.
#pragma once

#include "core/runtime/executor.hpp"
#include "core/runtime/sleeper.hpp"

namespace eciton::runtime {

/// Periods run on the monotonic clock, the services' time is CLOCK_REALTIME. Whole periods missed are
/// skipped and counted.
class RealtimeExecutor final : public Executor {
 public:
  RealtimeExecutor(const ExecutorConfig& config, std::vector<bus::Participant*> participants)
      : Executor(config, std::move(participants), ServiceGroup::Pacing::wall_clock) {}

  /// Becomes real-time if config.realtime_priority says so, with one warning if it may not.
  void run(const StopFlag& stop) override;

 private:
  void step_what_is_due() noexcept;
};

}  // namespace eciton::runtime
