// The flight of a demo: dock one after another, morph as one body, separate, land.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "deploy/command/fleet_flight.hpp"

namespace eciton::deploy {

struct DockingRecord {
  std::uint32_t follower = 0;
  std::uint32_t target = 0;
  double time_s = 0;  // from accepted to succeeded, on the modules' clock
  std::string declared_by;
  std::uint32_t recoveries = 0;
};

/// What a flight has shown.
struct DemoResult {
  std::vector<DockingRecord> dockings;
  DemoFigures figures;
  bool assembled = false;
  bool morphed = false;
  bool separated = false;
  double simulated_s = 0;
  double wall_s = 0;
};

class DemoFlight final : public FleetFlight {
 public:
  using FleetFlight::FleetFlight;

  /// Nothing when all went well.
  std::optional<FlightFailure> fly();

  const DemoResult& result() const { return result_; }

 private:
  // Steps; each throws FlightFailure.
  void dock_all();
  void hover_as_one_body();
  void morph();

  DemoResult result_;
};

}  // namespace eciton::deploy
