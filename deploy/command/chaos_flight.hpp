// A flight during which faults strike: what each did, and which bound it broke.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "deploy/command/chaos_leaks.hpp"
#include "deploy/command/chaos_plan.hpp"
#include "deploy/command/fleet_flight.hpp"

namespace eciton::deploy {

struct ChaosBounds {
  double back_s = 1.5;         // a process is in its role again after its kill or the end of its hang
  double heal_s = 2.0;         // all peers are heard again after a partition has ended
  double place_m = 0.3;        // where every module is again ...
  double place_within_s = 12;  // ... after so long
  double height_m_min = 0.3;   // nothing falls: they hover at 1.5 m
};

/// One cell, as it went.
struct ChaosOutcome {
  ChaosCell cell;
  std::string vendor;    // of the process, or the choice
  double back_s = 0;     // from the end of the cause until the role is filled, peers are heard
  double settled_s = 0;  // until all are at their places again
  double height_m_min = 0;
  double deviation_m_max = 0;         // of any module from its place
  std::vector<std::string> broken{};  // bounds, in words
};

class ChaosFlight final : public FleetFlight {
 public:
  ChaosFlight(const DemoFleet& fleet, Launches& launches, const runtime::StopFlag& stop, DemoView& view,
              FaultInjector injector, const ChaosPlan& plan);

  /// Nothing when the flight came to its end, whatever bounds were broken on the way.
  std::optional<FlightFailure> fly();
  const std::vector<ChaosOutcome>& outcomes() const { return outcomes_; }
  /// From the first blow that was settled to the last, of processes that were not struck.
  const MemoryGrowth::Most& memory_growth() const { return most_growth_; }

 private:
  void on_end(Launch& launch, const ChildReport& report) override;
  void approach_and_strike(const ChaosCell& cell);
  void strike(const ChaosCell& cell);
  void look(ChaosOutcome& outcome);
  /// By a process that has been heard since.
  bool role_filled(const ChaosCell& cell, Duration since) const;
  bool all_heard() const;
  bool all_at_place() const;
  bool flying_as_before() const;
  void take_places();
  void wait_until_apart();

  ChaosPlan plan_;
  ChaosBounds bounds_;
  FaultInjector injector_;
  std::vector<ChaosOutcome> outcomes_;
  std::vector<std::array<double, 3>> place_m_;  // by module, where it hovered before
  std::vector<std::size_t> chain_before_;       // members of its chain
  const ChaosCell* striking_ = nullptr;
  std::vector<std::string> ended_;  // by themselves
  MemoryGrowth growth_;
  MemoryGrowth::Most most_growth_;
};

}  // namespace eciton::deploy
