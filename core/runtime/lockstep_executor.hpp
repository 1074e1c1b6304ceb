// The executor of a simulated flight over real DDS: the module's hardware host hands out the time, tick by tick;
// we step what is due and acknowledge.
#pragma once

#include <vector>

#include "core/runtime/executor.hpp"
#include "core/runtime/sleeper.hpp"
#include "idl/topics.hpp"

namespace eciton::runtime {

/// Entries step in the order of phases. In a tick with an IMU sample a triggered one waits for a sample of that
/// tick, so that what one process computes reaches the next in the same tick; if none comes within the wall-clock
/// bound it steps without, and waits again only once its trigger is heard again.
class LockstepExecutor final : public Executor {
 public:
  struct Counts {
    std::uint64_t ticks = 0;
    std::uint64_t repeated = 0;   // received again, and acknowledged again
    std::uint64_t unsampled = 0;  // steps whose sample of the tick did not come in time
  };

  LockstepExecutor(const ExecutorConfig& config, std::vector<bus::Participant*> participants,
                   Duration sample_wait = std::chrono::seconds(1));

  void run(const StopFlag& stop) override;

  const Counts& counts() const { return counts_; }

 private:
  /// What a triggered entry's trigger had last when it was waited for in vain.
  struct Silence {
    bool silent = false;
    TimePoint newest{};
  };

  void follow(const msg::Clock& clock, Sleeper& sleeper);
  void step_tick(const msg::Clock& clock, Sleeper& sleeper);
  /// False: it is not waited for, and steps if it is due.
  bool await_sample(ServiceGroup::Entry& entry, Silence& silence, TimePoint stamp, Duration until, Sleeper& sleeper);
  void learn_period(const msg::Clock& clock);
  std::uint64_t next_tick(const msg::Clock& clock) const;

  bus::Reader<msg::Clock> clock_;
  bus::Writer<msg::ClockAck> acks_;
  Duration sample_wait_;
  std::vector<Silence> silences_;  // as the group's entries
  std::optional<msg::Clock> last_;
  Duration tick_period_{};  // zero: not known yet
  msg::ClockAck ack_;       // the last one
  Counts counts_;
};

}  // namespace eciton::runtime
