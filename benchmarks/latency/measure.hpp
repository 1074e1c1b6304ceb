// Opens the lanes, measures them in interleaved blocks, and keeps what came of it, however it ends.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmarks/latency/ddsperf.hpp"
#include "benchmarks/latency/plan.hpp"
#include "benchmarks/latency/stream.hpp"
#include "core/runtime/stop_signal.hpp"

namespace eciton::bench {

struct Measured {
  std::vector<Stream> streams;
  std::vector<DdsperfRun> ddsperf;
  std::vector<std::string> notes;
  bool interrupted = false;
  bool partial = false;  // something broke, or there was an interruption
  bool missing = false;  // a baseline that was asked for
};

/// finished, all, seconds left, what is being done.
using Progress = std::function<void(std::size_t, std::size_t, double, const std::string&)>;

Measured measure_latency(const LatencyOptions& options, const Plan& plan, const runtime::StopFlag& stop,
                         const Progress& progress);

}  // namespace eciton::bench
