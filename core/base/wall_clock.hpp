// Reads the machine's clocks. For executors, hosts and tools: a service or a maths file is given the time
// and never includes this.
#pragma once

#include <algorithm>
#include <ctime>

#include "core/base/time.hpp"

namespace eciton {

namespace wall_clock_detail {

inline std::int64_t read_ns(clockid_t clock) noexcept {
  timespec t{};
  ::clock_gettime(clock, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

}  // namespace wall_clock_detail

/// The module's clock on a robot: CLOCK_REALTIME, which chrony or PTP may step. Real-time safe.
inline TimePoint wall_now() noexcept { return from_ns(wall_clock_detail::read_ns(CLOCK_REALTIME)); }

/// CLOCK_MONOTONIC since its own epoch: for periods and waits. Real-time safe.
inline Duration monotonic_now() noexcept { return Duration{wall_clock_detail::read_ns(CLOCK_MONOTONIC)}; }

/// For calls of the system that wait: for so long, or until that instant of a clock. Negative: zero.
constexpr timespec to_timespec(Duration d) noexcept {
  const Duration::rep ns = std::max<Duration::rep>(d.count(), 0);
  return {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
}

}  // namespace eciton
