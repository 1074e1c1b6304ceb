// The hardware host's end of lockstep: hands out ticks to the module's processes and waits until each that has
// something to do in it has done it.
#pragma once

#include <string>
#include <vector>

#include "core/bus/participant.hpp"
#include "core/runtime/sleeper.hpp"
#include "idl/topics.hpp"

namespace eciton::runtime {

/// A tick is published again while acknowledgements are missing: matching is one-sided in DDS, so that a
/// process may miss the first; the first tick is thus the handshake as well. Other readers of the participant
/// should not wake: participant.set_all_wake(false) before this is made.
class LockstepMaster {
 public:
  /// `processes`: the names in their executors' configs. `stop` ends a wait.
  LockstepMaster(bus::Participant& participant, const std::vector<std::string>& processes, const StopFlag& stop,
                 Duration publish_again_after = std::chrono::milliseconds(100));

  /// Hands out a tick; ticks increase. `imu_sampled`: the IMU sample of this tick was published before.
  void publish(std::uint64_t tick, TimePoint stamp, bool imu_sampled);

  /// Takes what has come; whether all whom the published tick concerns have acknowledged it.
  bool all_acknowledged();

  /// Waits for that; after `timeout` of wall clock, or a stop, an error that names each process that did not
  /// acknowledge and the last tick it did.
  Status wait_for_acks(Duration timeout);

  /// Acknowledgements of a tick with an IMU sample that acted on an older one.
  std::uint64_t stale_inputs() const { return stale_inputs_; }
  std::uint64_t published_again() const { return published_again_; }

 private:
  struct Process {
    std::string name;
    std::uint32_t key;
    bool heard = false;
    std::uint64_t last_tick = 0;
    std::uint64_t next_tick = 0;
  };

  bool is_missing(const Process& process) const;
  void note(const msg::ClockAck& ack);
  Error missing(Duration timeout) const;

  bus::Writer<msg::Clock> clock_;
  bus::Reader<msg::ClockAck> acks_;
  Sleeper sleeper_;
  Duration publish_again_after_;
  std::vector<Process> processes_;
  msg::Clock current_;
  std::uint64_t stale_inputs_ = 0;
  std::uint64_t published_again_ = 0;
};

}  // namespace eciton::runtime
