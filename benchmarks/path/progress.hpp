// How a benchmark tells how far it is, and how it is told to end: what was measured until then is its result.
#pragma once

#include <functional>
#include <string>

#include "core/runtime/stop_signal.hpp"

namespace eciton::bench {

/// finished, all, seconds left, what is being done.
using Progress = std::function<void(std::size_t, std::size_t, double, const std::string&)>;

/// Both, on their way through a benchmark.
struct RunControl {
  const runtime::StopFlag& stop;
  const Progress& progress;

  void tell(std::size_t finished, std::size_t all, double left_s, const std::string& doing) const {
    if (progress) progress(finished, all, left_s, doing);
  }
};

}  // namespace eciton::bench
