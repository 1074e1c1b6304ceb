// A command names its state by stamp; the state was made of the newest IMU sample before it.
#include "benchmarks/path/path_trace.hpp"

#include <algorithm>
#include <cstring>
#include <unordered_map>

namespace eciton::bench {

std::uint64_t command_print(std::span<const RotorPrint> rotors) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a over the doubles
  const auto mix = [&hash](double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 1099511628211u;
    hash ^= hash >> 29;
  };
  for (const RotorPrint& rotor : rotors) {
    mix(rotor.thrust_N);
    mix(rotor.gimbal_rad[0]);
    mix(rotor.gimbal_rad[1]);
  }
  return hash;
}

namespace {

/// Counts a tick; whether it brought a command that is new.
bool brings_news(const LinkTick& tick, std::uint64_t& before, PathTrace& trace) {
  ++trace.ticks;
  if (tick.in_ns == 0) {
    ++trace.unanswered;
    return false;
  }
  const bool repeated = tick.command == before;
  before = tick.command;
  trace.repeated += repeated ? 1 : 0;
  return !repeated;
}

}  // namespace

PathTrace trace_link(std::span<const LinkTick> ticks) {
  PathTrace trace;
  trace.samples.reserve(ticks.size());
  std::uint64_t before = 0;
  for (const LinkTick& tick : ticks) {
    if (!brings_news(tick, before, trace)) continue;
    trace.samples.push_back(
        {.out_ns = tick.out_ns, .rotors_ns = tick.in_ns - tick.out_ns, .age_ns = tick.in_ns - tick.imu_stamp_ns});
  }
  return trace;
}

PathTrace trace_path(std::span<const LinkTick> ticks, std::span<const CommandSeen> commands) {
  std::unordered_map<std::uint64_t, const CommandSeen*> by_print;
  for (const CommandSeen& command : commands) by_print.emplace(command.print, &command);
  PathTrace trace;
  trace.samples.reserve(ticks.size());
  std::uint64_t before = 0;
  for (const LinkTick& tick : ticks) {
    if (!brings_news(tick, before, trace)) continue;
    const auto found = by_print.find(tick.command);
    if (found == by_print.end()) {
      ++trace.unseen;
      continue;
    }
    const CommandSeen& command = *found->second;
    const auto after = std::upper_bound(ticks.begin(), ticks.end(), command.state_stamp_ns,
                                        [](std::int64_t stamp, const LinkTick& t) { return stamp < t.out_ns; });
    if (after == ticks.begin()) continue;  // made before the trace began
    const LinkTick& imu = *(after - 1);
    if (imu.out_ns != tick.out_ns) ++trace.late;
    trace.samples.push_back({.out_ns = imu.out_ns,
                             .estimation_ns = command.state_stamp_ns - imu.out_ns,
                             .control_ns = command.stamp_ns - imu.out_ns,
                             .rotors_ns = tick.in_ns - imu.out_ns,
                             .age_ns = tick.in_ns - imu.imu_stamp_ns});
  }
  return trace;
}

}  // namespace eciton::bench
