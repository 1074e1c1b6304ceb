// The baseline of wake-up jitter: cyclictest of rt-tests, its every sample.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/time.hpp"
#include "core/runtime/stop_signal.hpp"

namespace eciton::bench {

/// Path of a program as a shell would find it; an Error names the package that brings it.
eciton::Result<std::string> find_tool(const std::string& program, const std::string& package);

struct CyclictestRun {
  Duration period = std::chrono::milliseconds(2);
  int realtime_priority = 0;
  double seconds = 5;
};

/// How its samples are printed, each: "       0:      12:   32548" (thread, cycle, nanoseconds late).
std::vector<double> parse_cyclictest_us(std::string_view output);

/// Runs it with its attempts to tune the machine switched off, and returns how late each wake-up was, in µs. An Error
/// holds what it said when it did not measure.
eciton::Result<std::vector<double>> run_cyclictest(const std::string& program, const CyclictestRun& run,
                                                   const runtime::StopFlag& stop);

}  // namespace eciton::bench
