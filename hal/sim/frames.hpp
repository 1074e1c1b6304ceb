// What passes between a simulated module and its hardware host each tick: one frame of readings, one of
// commands. Plain bytes, so that a frame is the same in a process and on a socket.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "core/base/time.hpp"
#include "hal/interfaces.hpp"

namespace eciton::hal::sim {

inline constexpr std::size_t max_rotors = 8;
inline constexpr std::size_t max_joints = 8;
inline constexpr std::size_t max_ports = 4;

struct SensorFrame {
  TimePoint stamp;
  std::uint32_t module_id = 0;
  std::uint32_t rotor_count = 0;
  std::uint32_t joint_count = 0;
  std::uint32_t port_count = 0;
  std::uint64_t imu_count = 0;   // samples so far: one more, and `imu` is new, whatever its stamp says
  std::uint64_t pose_count = 0;  // likewise; 0 until the first measurement has arrived
  ImuReading imu;                // the newest sample
  PoseReading pose;              // the newest that has arrived, stamped when it was measured
  std::array<RotorReading, max_rotors> rotors{};
  std::array<JointReading, max_joints> joints{};
  std::array<LatchReading, max_ports> latches{};
};

/// A latch is bistable: without power, or on `hold`, it stays as it was last told.
enum class LatchCommand : std::uint8_t { hold, engage, release };

struct ActuatorFrame {
  TimePoint stamp;                                    // of the sensor frame acted on
  bool armed = false;                                 // false: motors run down, whatever the setpoints say
  bool joints_powered = false;                        // false: joints swing freely, braked by their gears
  std::array<RotorSetpoint, max_rotors> rotors{};     // thrusts as they were asked for: to read along
  std::array<double, max_rotors> throttle_percent{};  // what the speed controllers get: see core/robot/thrust_map.hpp
  std::array<JointSetpoint, max_joints> joints{};
  std::array<LatchCommand, max_ports> latches{};
};

static_assert(std::is_trivially_copyable_v<SensorFrame>);
static_assert(std::is_trivially_copyable_v<ActuatorFrame>);

}  // namespace eciton::hal::sim
