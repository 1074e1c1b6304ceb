// All services of all modules in one process and one thread, in virtual time, with the world behind a Plant:
// the same inputs give the same bits, many times faster than the wall clock.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/runtime/plant.hpp"
#include "core/runtime/service_group.hpp"

namespace eciton::runtime {

struct SimConfig {
  TimePoint start{};
  Duration tick = std::chrono::milliseconds(2);
};

/// A module in simulation: its services, and how its clock runs beside the world's.
class SimModule {
 public:
  /// `now`: the simulation's time.
  SimModule(const ExecutorConfig& config, std::vector<bus::Participant*> participants, const TimePoint& now);

  /// Before a run or between ticks; the first step is at the next tick at the earliest. The service outlives
  /// the module, or is removed first.
  void add(Service& service);
  /// As if its process had died.
  void remove(const Service& service);
  /// As if its process hung: it steps and beats no more until resumed.
  void suspend(const Service& service, bool suspended);

  /// The module's clock, from now on: the world's time plus `offset` plus `drift_ppb` nanoseconds a second.
  void set_clock(Duration offset, std::int64_t drift_ppb = 0) {
    clock_offset_ = offset, clock_drift_ppb_ = drift_ppb;
  }
  TimePoint clock_at(TimePoint world) const;

  ServiceGroup& group() { return group_; }

 private:
  friend class SimExecutor;
  ServiceGroup group_;
  const TimePoint& now_;
  Duration clock_offset_{};
  std::int64_t clock_drift_ppb_ = 0;
  bool changed_ = true;
};

class SimExecutor {
 public:
  /// `advance_network` delivers what is due at a time; empty: the network needs no telling.
  SimExecutor(const SimConfig& config, Plant& plant, std::function<void(TimePoint)> advance_network);

  /// Modules of one phase step in the order in which they were added here.
  SimModule& add_module(const ExecutorConfig& config, std::vector<bus::Participant*> participants);

  /// Called in each tick after the services have stepped and before the world moves on. In order of addition.
  void observe(std::function<void(TimePoint)> observer) { observers_.push_back(std::move(observer)); }

  /// The network delivers, the services step, heartbeats go out, observers look, the world moves on.
  void tick();
  /// Ticks while the time is before `end`.
  void run_until(TimePoint end);
  /// Ticks until `done` holds, looked at before each tick, or the time is `limit`; whether it holds.
  bool run_until(const std::function<bool()>& done, TimePoint limit);

  /// Of the next tick.
  TimePoint now() const { return now_; }
  std::uint64_t ticks() const { return ticks_; }

 private:
  void collect_entries();

  struct Due {
    SimModule* module;
    ServiceGroup::Entry* entry;
  };

  SimConfig config_;
  Plant& plant_;
  std::function<void(TimePoint)> advance_network_;
  std::vector<std::unique_ptr<SimModule>> modules_;
  std::vector<std::function<void(TimePoint)>> observers_;
  std::vector<Due> order_;  // by phase, module, addition
  TimePoint now_;
  std::uint64_t ticks_ = 0;
};

}  // namespace eciton::runtime
