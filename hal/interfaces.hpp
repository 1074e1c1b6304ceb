// The hardware of a module as the hardware host sees it. Lifecycle as ros2_control defines it:
// unconfigured -> inactive (readable, unpowered) -> active (powered, commands act) -> finalized.
// configure, activate and deactivate may block and allocate; read and write are real-time safe, bounded
// and called from one thread. Each backend documents what power and commands mean in each state.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/base/result.hpp"
#include "core/base/time.hpp"

namespace eciton::hal {

enum class Io {
  ok,
  nothing_new,  // no reading since the last one
  timeout,      // the device did not answer within its share of the cycle
  error         // it answered wrongly, or is gone; counted by the backend
};

class Device {
 public:
  virtual ~Device() = default;
  virtual Status configure() = 0;
  virtual Status activate() = 0;
  virtual void deactivate() noexcept = 0;
};

template <class Command, class State>
class ActuatorBus : public Device {
 public:
  virtual Io write(std::span<const Command> commands) noexcept = 0;
  virtual Io read(std::span<State> states) noexcept = 0;
};

struct RotorSetpoint {
  double thrust_N = 0;
  std::array<double, 2> gimbal_rad{};  // phi, theta
};
struct RotorReading {
  double thrust_N = 0;
  std::array<double, 2> gimbal_rad{};
  double battery_V = 0;
};
using RotorBus = ActuatorBus<RotorSetpoint, RotorReading>;

struct JointSetpoint {
  double position_rad = 0;
  double velocity_rad_s = 0;
};
struct JointReading {
  double position_rad = 0;
  double velocity_rad_s = 0;
  double torque_Nm = 0;
};
using JointBus = ActuatorBus<JointSetpoint, JointReading>;

enum class LatchReading { open, ready, latched };

/// One docking port's latch.
class Latch : public Device {
 public:
  /// true: hold whatever makes contact; false: let go.
  virtual Io write(bool engage) noexcept = 0;
  virtual Io read(LatchReading& reading) noexcept = 0;
};

struct ImuReading {
  TimePoint stamp;
  std::array<double, 3> specific_force_M_m_s2{};
  std::array<double, 3> w_WM_M_rad_s{};
};

class Imu : public Device {
 public:
  virtual Io read(ImuReading& reading) noexcept = 0;
};

enum class PoseSourceKind { mocap, lio };

struct PoseReading {
  TimePoint stamp;  // when it was measured
  PoseSourceKind source = PoseSourceKind::mocap;
  std::array<double, 3> p_WB_m{};
  std::array<double, 4> q_WB{1, 0, 0, 0};
  double position_std_m = 0;
  double attitude_std_rad = 0;
};

class PoseSource : public Device {
 public:
  virtual Io read(PoseReading& reading) noexcept = 0;
};

}  // namespace eciton::hal
