// One simulated module, its processes and its world, brought into a hover with a tap on the link to its board.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/path/path.hpp"
#include "benchmarks/path/path_trace.hpp"
#include "idl/fleet.hpp"

namespace eciton::bench {

/// Which processes, over which vendor.
struct FlightVariant {
  std::string vendor;
  std::string layout;
  std::string name() const { return layout + "." + vendor; }
  /// Whether there are stages to see from outside. A listener in one process would cost more than all the rest: what
  /// it hears has to be sent.
  bool staged() const { return layout != "one-process"; }
};

struct FlightRecord {
  PathTrace trace;
  std::vector<LinkTick> ticks;
  std::vector<InsideSample> inside;
  std::vector<msg::Heartbeat> heartbeats;  // the last one of each service
  std::string trouble;                     // why less was measured than was asked for; empty: nothing
};

/// Starts everything, waits for the hover, records for options.seconds and stops everything.
FlightRecord fly(const PathOptions& options, const FlightVariant& variant, const RunControl& control,
                 const std::function<void(const std::string& doing)>& tell);

/// The names of a variant's processes; throws BadInput on an unknown layout or vendor, or when a program or plugin
/// is not there.
void check_variant(const PathOptions& options, const FlightVariant& variant);

}  // namespace eciton::bench
