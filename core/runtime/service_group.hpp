// The services of one process (in simulation, of one module) as every executor keeps them: when each falls
// due, stepping in the order of phases, statistics and heartbeats. The executors differ in who moves time.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/bus/participant.hpp"
#include "core/runtime/checkpoint.hpp"
#include "core/runtime/cycle_statistics.hpp"
#include "core/runtime/service.hpp"
#include "core/runtime/watchdog.hpp"

namespace eciton::runtime {

struct ExecutorConfig {
  std::uint32_t module_id = 0;
  std::string process = "eciton";
  int realtime_priority = 0;  // SCHED_FIFO, 1 to 99, with memory locked; 0: as the system schedules it
  Duration heartbeat_period = std::chrono::milliseconds(10);  // 0: no heartbeats
  std::filesystem::path checkpoints{};  // directory where services find and leave their state; empty: they start anew
};

/// Instants on the clock that paces an executor, since that clock's epoch: monotonic on a robot, the
/// world's time in lockstep and simulation. The module's time, which stamps carry, may step; this one not.
using Pace = Duration;

class ServiceGroup {
 public:
  /// Whose clock paces the group. simulated: execution times and the process id are reported as zero, so that a
  /// run is the same to the bit. How long a step takes is an overrun on the wall clock only.
  enum class Pacing { wall_clock, lockstep, simulated };

  struct Entry {
    Service* service;
    Schedule schedule;
    Pace next_due{};         // the next step of a periodic service; when a triggered one has waited long enough
    std::uint64_t news = 0;  // of its trigger, when it last stepped
    bool suspended = false;  // neither steps nor beats: a hang, for tests of failures
    LoopProgress steps;
    CycleStatistics statistics;
    msg::Heartbeat heartbeat;  // what does not change is filled in
    std::unique_ptr<Checkpoint> checkpoint;

    bool triggered() const { return schedule.trigger != nullptr; }
  };

  /// `participants`: all that the services use, the one on the module ring first; heartbeats go there.
  ServiceGroup(const ExecutorConfig& config, std::vector<bus::Participant*> participants, Pacing pacing);
  ServiceGroup(const ServiceGroup&) = delete;
  ServiceGroup& operator=(const ServiceGroup&) = delete;

  /// Before a run; between ticks of a simulation, where it is due from `at` on. Takes up the service's checkpoint,
  /// if there is one. Throws BadInput on a bad schedule or a second service of one name.
  Entry& add(Service& service, Pace at = Pace::zero());
  /// Between ticks: it steps no more, as if its process had died.
  void remove(const Service& service);

  /// Periodic services are first due at `at`; triggered ones have waited from then.
  void start(Pace at);

  /// From here on samples lie until a step takes them, without waking the thread ...
  void mute();
  /// ... but those of triggers.
  void wake_by_triggers();

  /// Whether the entry is to step at `at`: its time has come, or its trigger has a sample that came since its
  /// last step began. Samples a service leaves in its trigger are not stepped for again. Real-time safe.
  bool due(Entry& entry, Pace at) noexcept;
  /// Steps it, as module time `now`; returns when the step ended (simulated: `at`). Real-time safe if the service is.
  Pace step(Entry& entry, Pace at, TimePoint now) noexcept;
  /// For a watchdog, from its thread, while nothing is added or removed: a service that has not stepped since this
  /// last found none; empty: all have.
  std::string_view find_idle() noexcept;
  /// Publishes a heartbeat of every service, and hands its state to its checkpoint, if it is time. Real-time safe.
  void beat_if_due(Pace at, TimePoint now) noexcept;

  /// A last heartbeat of every service, that says so: those who listen wait for no further one.
  void say_farewell(TimePoint now) noexcept;

  /// When something falls due by time alone; with heartbeats, or without.
  Pace next_due() const noexcept;
  Pace next_step_due() const noexcept;
  bool has_triggers() const;

  /// In the order in which they step.
  const std::vector<std::unique_ptr<Entry>>& entries() const { return entries_; }
  const ExecutorConfig& config() const { return config_; }
  bus::Participant& module_ring() { return *participants_.front(); }
  /// Of the waker all participants share: one thread waits for them.
  bus::Waker& waker() { return participants_.front()->waker(); }

  /// One line per service, for people.
  std::string table() const;

 private:
  void fill_constant_fields(Entry& entry);
  void take_up_checkpoint(Entry& entry);
  void learn_clock_offsets() noexcept;

  ExecutorConfig config_;
  std::vector<bus::Participant*> participants_;
  Pacing pacing_;
  std::vector<std::unique_ptr<Entry>> entries_;
  std::optional<bus::Writer<msg::Heartbeat>> heartbeat_;
  std::optional<bus::Reader<msg::RadioState>> radio_state_;  // which knows how the peers' clocks stand
  Pace next_heartbeat_ = Pace::max();
  Pace next_checkpoint_{};
};

}  // namespace eciton::runtime
