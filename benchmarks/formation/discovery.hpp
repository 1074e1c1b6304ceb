// What it costs on the air that N modules find each other and stay known: with the design's settings, and with the
// vendors' own defaults.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "benchmarks/formation/fleet.hpp"
#include "benchmarks/formation/rtps_meter.hpp"

namespace eciton::bench {

struct DiscoveryCase {
  bool lean = true;  // the design's radios and their static peers; false: participants as the vendor makes them
  std::string vendor;
  std::uint32_t modules = 2;
  std::string name() const {
    return std::string(lean ? "lean" : "default") + "." + vendor + "." + std::to_string(modules);
  }
};

/// Over all modules; Ethernet frames with their headers.
struct DiscoveryCount {
  double seconds = 0;
  TrafficCount total{}, discovery{}, participants{}, endpoints{}, liveliness{}, unreachable{};
  TrafficCount topics{}, beacons{}, multicast{}, other{};
};

struct DiscoveryFigures {
  DiscoveryCount joining;  // from the start of the last module on
  DiscoveryCount idle;
  std::uint64_t missed = 0;  // frames that could not be counted
};

/// Throws FormationFailure when a module ends or it is interrupted.
DiscoveryFigures measure_discovery(const FormationOptions& options, const DiscoveryCase& which,
                                   const net::OwnedNet& net, const RunControl& control);

}  // namespace eciton::bench
