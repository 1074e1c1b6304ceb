// Starts eciton-bench-overhead and reads its one line.
#include "benchmarks/latency/overhead.hpp"

#include <cstdio>
#include <limits>

#include "benchmarks/latency/process.hpp"
#include "core/base/wall_clock.hpp"

namespace eciton::bench {

bool parse_overhead(const std::string& line, Overhead& overhead) {
  return std::sscanf(line.c_str(), "overhead %lf %lf %lf %lf", &overhead.write_ns, &overhead.take_ns,
                     &overhead.allocations, &overhead.sim_network_us) == 4;
}

Overhead measure_overhead(const LatencyOptions& options, const runtime::StopFlag& stop) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Overhead overhead{nan, nan, nan, nan, {}};
  Result<Process> started = Process::start(overhead_program(options));
  if (!started) {
    overhead.trouble = started.error().message;
    return overhead;
  }
  const Result<std::string> line = started->hear(monotonic_now() + std::chrono::seconds(5), stop);
  if (!line) overhead.trouble = line.error().message;
  if (line && !parse_overhead(*line, overhead)) overhead.trouble = "eciton-bench-overhead said '" + *line + "'";
  return overhead;
}

}  // namespace eciton::bench
