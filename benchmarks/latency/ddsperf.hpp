// Cyclone DDS's own measuring program as a baseline: started for a second at a time between our blocks, its words
// parsed. It reports half of each round trip, and quantiles instead of samples.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmarks/latency/plan.hpp"
#include "core/runtime/stop_signal.hpp"

namespace eciton::bench {

/// Whole round trips: twice what ddsperf says.
struct DdsperfWindow {
  double mean_us = 0, p50_us = 0, p90_us = 0, p99_us = 0, max_us = 0;
  std::size_t count = 0;
};

/// "[7] 1.000  host:6 size 256 mean 40.2us min 16.9us 50% 39.5us 90% 48.1us 99% 62.3us max 488.5us cnt 969"
std::optional<DdsperfWindow> parse_ddsperf(const std::string& line);

struct DdsperfRun {
  Cell cell;
  std::string delivery;
  std::vector<DdsperfWindow> windows;
};

/// Where it is; empty: nowhere in the path.
std::string find_ddsperf();

/// One second of it, added to `run`; the Error says why nothing came of it.
Status measure_ddsperf(const LatencyOptions& options, const Place& place, const std::string& program, DdsperfRun& run,
                       const runtime::StopFlag& stop);

}  // namespace eciton::bench
