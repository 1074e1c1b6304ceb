// How a benchmark tells how far it is, and how it is told to end: what was measured until then is its result.
#pragma once

#include <functional>
#include <string>

#include "core/runtime/stop_signal.hpp"

namespace eciton::bench {

struct Progress {
  /// As ProgressLine::show; empty: nobody looks.
  std::function<void(std::size_t finished, std::size_t all, double left_s, const std::string& doing)> show;
  const runtime::StopFlag& stop;

  void tell(std::size_t finished, std::size_t all, double left_s, const std::string& doing) const {
    if (show) show(finished, all, left_s, doing);
  }
};

}  // namespace eciton::bench
