// Time points and durations of a module's clock, in nanoseconds. Nothing here reads a clock: a service
// is given the time. Executors read it through core/base/wall_clock.hpp.
#pragma once

#include <chrono>
#include <cstdint>

namespace eciton {

using Duration = std::chrono::nanoseconds;

/// The clock of one module: CLOCK_REALTIME on a robot, the world's time in lockstep and simulation.
struct ModuleClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = Duration;
  using time_point = std::chrono::time_point<ModuleClock, Duration>;
  static constexpr bool is_steady = false;
};

using TimePoint = ModuleClock::time_point;

using namespace std::chrono_literals;

constexpr TimePoint from_ns(std::int64_t stamp_ns) { return TimePoint{Duration{stamp_ns}}; }
constexpr std::int64_t to_ns(TimePoint t) { return t.time_since_epoch().count(); }
constexpr double to_s(Duration d) { return std::chrono::duration<double>(d).count(); }
constexpr Duration from_s(double s) { return std::chrono::round<Duration>(std::chrono::duration<double>(s)); }

}  // namespace eciton
