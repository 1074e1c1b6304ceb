// From what was seen on the link to the board and on the module's ring to the stages between an IMU sample
// and the rotor command made of it. Pure: all times are stamps of one clock, in nanoseconds.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace eciton::bench {

/// One tick on the link between a board and its hardware host.
struct LinkTick {
  std::int64_t imu_stamp_ns = 0;  // as the IMU sample says
  std::int64_t out_ns = 0;        // when the readings went to the host
  std::int64_t in_ns = 0;         // when the host's commands came; 0: none came for this tick
  std::uint64_t command = 0;      // which one: command_print of what the rotors were told
};

/// A rotor command as it was on the ring.
struct CommandSeen {
  std::int64_t stamp_ns = 0;        // when control began the step that made it
  std::int64_t state_stamp_ns = 0;  // when estimation began the step that made the state acted on
  std::uint64_t print = 0;
};

/// Tells commands apart by their setpoints' bits: in flight no two are alike.
struct RotorPrint {
  double thrust_N = 0;
  std::array<double, 2> gimbal_rad{};
};
std::uint64_t command_print(std::span<const RotorPrint> rotors);

/// The way of one IMU sample; times in ns since it went out to the host.
struct PathSample {
  std::int64_t out_ns = 0;
  std::int64_t estimation_ns = 0;  // estimation began its step
  std::int64_t control_ns = 0;     // control began its step
  std::int64_t rotors_ns = 0;      // the command was back on the link
  std::int64_t age_ns = 0;         // then, of the IMU sample by its own stamp
};

/// What a module in one process says of itself: its own work, without the link's ends.
struct InsideSample {
  std::int64_t in_ns = 0;   // readings were there
  std::int64_t out_ns = 0;  // commands were made
};

struct PathTrace {
  std::vector<PathSample> samples;  // in the order of the commands
  std::uint64_t ticks = 0;
  std::uint64_t unanswered = 0;  // ticks for which the host sent nothing
  std::uint64_t repeated = 0;    // answered with the command of the tick before: none was new
  std::uint64_t late = 0;        // answered with a command made of an earlier tick's IMU sample
  std::uint64_t unseen = 0;      // answered with a command that was not seen on the ring
};

/// `ticks` and `commands` in the order of their times.
PathTrace trace_path(std::span<const LinkTick> ticks, std::span<const CommandSeen> commands);

/// From the link alone, for a module that acts on an IMU sample within its tick or not at all: without stages.
PathTrace trace_link(std::span<const LinkTick> ticks);

}  // namespace eciton::bench
