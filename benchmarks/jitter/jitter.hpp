// `bench jitter`: how punctually a 500 Hz service that does control's work is woken by our executor, beside
// cyclictest at the same period and priority, in turn: on an idle machine, a loaded one, and with DDS traffic.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/path/progress.hpp"
#include "benchmarks/report/result.hpp"

namespace eciton::bench {

struct JitterOptions {
  std::vector<std::string> conditions{"idle", "loaded", "traffic"};
  double block_s = 5;
  std::size_t rounds = 8;      // blocks of each of the two, per condition, forward and backward in turn
  int realtime_priority = 80;  // of both, SCHED_FIFO; 0: both as the system schedules them
  bool cyclictest = true;      // false: without the baseline
  std::string dds = "cyclonedds";
  std::uint32_t domain = 97;
  std::uint64_t seed = 1;            // of the confidence interval
  std::filesystem::path programs{};  // where eciton-bench-traffic is
};

/// Throws BadInput before anything starts when a right or a tool is missing.
Result run_jitter(const JitterOptions& options, const runtime::StopFlag& stop, const Progress& progress);

}  // namespace eciton::bench
