// What the framework's own code costs a sample, without any vendor: measured in a process of its own, which it is
// started as, under the peers' footing.
#pragma once

#include <string>

#include "benchmarks/latency/plan.hpp"
#include "core/runtime/stop_signal.hpp"

namespace eciton::bench {

/// Medians over batches; NaN: not measured, see `trouble`.
struct Overhead {
  double write_ns = 0;  // serialize and hand over, 256 B
  double take_ns = 0;   // take and deserialize, 256 B
  double allocations = 0;
  double sim_network_us = 0;  // from before write to after take, two participants in one process, 256 B
  std::string trouble;
};

Overhead measure_overhead(const LatencyOptions& options, const runtime::StopFlag& stop);

/// "overhead WRITE TAKE ALLOCATIONS SIM" as that process says it.
bool parse_overhead(const std::string& line, Overhead& overhead);

}  // namespace eciton::bench
