// What a run of `bench latency` measures: which lanes side by side, with which payloads, and for how long.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/latency/lane.hpp"
#include "benchmarks/latency/place.hpp"
#include "core/base/result.hpp"

namespace eciton::bench {

struct LatencyOptions {
  std::vector<std::string> vendors{"cyclonedds", "fastdds"};  // every ordered pair of them
  std::vector<std::uint32_t> bytes{64, 256, 1024, 4096};
  std::vector<double> rates_Hz{1000};
  std::vector<std::string> qos{"sensor"};
  std::vector<std::string> deliveries{"wake", "inline"};
  std::vector<std::string> baselines{"native", "udp", "ddsperf", "zeromq", "lcm"};
  double duration_s = 10;  // of each lane with each payload, rate and QoS class
  // The first sample after a turn finds caches cold: of 100 in a block it would be the 99th percentile.
  double block_s = 0.25;
  bool quick = false;
  std::string network_interface = "lo";
  std::vector<std::string> over{"loopback"};
  std::vector<std::string> hosts;  // two network namespaces for "hosts" and "impaired"; none: a net of our own
  std::vector<std::string> impairment{"delay=10ms", "jitter=3ms", "loss=5%"};  // as `eciton net set` takes it
  std::vector<std::string> peers;  // addresses for discovery; none: multicast
  std::uint32_t domain = 60;       // of the first lane; each next one has the next
  int priority = -1;               // of all peers, SCHED_FIFO; 0: SCHED_OTHER; -1: 20 where it may be
  bool pin = true;                 // pings on the first processor, echoes on the second
  double patience_s = 10;          // for peers to appear
  std::uint64_t seed = 1;          // of the bootstrap
  std::string programs;            // directory of the peers; empty: beside this program
};

/// The allowed words, for messages.
const std::vector<std::string>& latency_baselines();

/// One payload, rate and QoS class, measured on all lanes in turn.
struct Cell {
  std::uint32_t bytes = 0;
  double rate_Hz = 0;
  std::string qos, over;
  bool plain = true;           // the first rate, class and place: metric names leave them out
  std::string suffix() const;  // "256": as metric names end
};

struct Plan {
  std::vector<Cell> cells;
  std::size_t rounds = 0;          // blocks of each lane in each cell
  std::vector<std::string> notes;  // what cannot be measured here, and why
  bool missing = false;            // a baseline that was asked for
};

/// Checks the options against each other and the machine; the Error is for exit status 2.
Result<Plan> make_plan(LatencyOptions& options);
/// The lanes of one QoS class. Baselines whose programs are not there become notes.
std::vector<LaneSpec> lanes_of(const LatencyOptions& options, const Place& place, const std::string& qos,
                               std::vector<std::string>& notes);
/// What a program of one role is started with.
Footing footing(const LatencyOptions& options, const Place& place, bool ping);

/// The program of overhead.hpp.
ProgramSpec overhead_program(const LatencyOptions& options);

}  // namespace eciton::bench
