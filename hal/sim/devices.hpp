// The five devices of a simulated module, on its board. All follow the lifecycle of hal/interfaces.hpp:
// from configure on they can be read; commands act, and are accepted, only while active. No call blocks,
// allocates or locks; the board's thread is theirs.
#pragma once

#include "core/robot/thrust_map.hpp"
#include "hal/interfaces.hpp"
#include "hal/sim/board.hpp"

namespace eciton::hal::sim {

/// Lifecycle shared by the devices.
class Lifecycle {
 public:
  enum class State { unconfigured, inactive, active };
  State state() const { return state_; }
  bool readable() const { return state_ != State::unconfigured; }
  bool active() const { return state_ == State::active; }
  void configure() {
    if (state_ == State::unconfigured) state_ = State::inactive;
  }
  Status activate(const char* device);
  void deactivate() {
    if (active()) state_ = State::inactive;
  }

 private:
  State state_ = State::unconfigured;
};

/// Motors and gimbals. Active: armed. Inactive: motors run down, whatever the setpoints were. Thrust becomes a
/// throttle at the battery's voltage, as measured; without compensation, at the voltage there was when it was armed.
class SimRotorBus : public RotorBus {
 public:
  SimRotorBus(Board& board, std::size_t rotors, const robot::ThrustMap& map, bool compensates = true)
      : board_(board), rotors_(rotors), map_(map), compensates_(compensates) {}
  Status configure() override;
  /// Arms with all thrusts at zero.
  Status activate() override;
  void deactivate() noexcept override;
  /// One setpoint per rotor, or Io::error.
  Io write(std::span<const RotorSetpoint> commands) noexcept override;
  Io read(std::span<RotorReading> states) noexcept override;

 private:
  void follow_battery(double share);

  Board& board_;
  std::size_t rotors_;
  robot::ThrustMap map_;
  bool compensates_;
  double battery_V_ = 0;  // smoothed; 0: not read yet
  Lifecycle lifecycle_;
  std::uint64_t frames_read_ = 0;
};

/// Dock joints. Active: servos hold where they are until told otherwise. Inactive: they swing freely.
class SimJointBus : public JointBus {
 public:
  SimJointBus(Board& board, std::size_t joints) : board_(board), joints_(joints) {}
  Status configure() override;
  Status activate() override;
  void deactivate() noexcept override;
  Io write(std::span<const JointSetpoint> commands) noexcept override;
  Io read(std::span<JointReading> states) noexcept override;

 private:
  Board& board_;
  std::size_t joints_;
  Lifecycle lifecycle_;
  std::uint64_t frames_read_ = 0;
};

/// One port's latch. It is bistable: deactivating it, or losing its host, leaves it as it was.
class SimLatch : public Latch {
 public:
  SimLatch(Board& board, std::size_t port) : board_(board), port_(port) {}
  Status configure() override;
  Status activate() override;
  void deactivate() noexcept override;
  Io write(bool engage) noexcept override;
  Io read(LatchReading& reading) noexcept override;

 private:
  Board& board_;
  std::size_t port_;
  Lifecycle lifecycle_;
  std::uint64_t frames_read_ = 0;
};

class SimImu : public Imu {
 public:
  explicit SimImu(Board& board) : board_(board) {}
  Status configure() override;
  Status activate() override;
  void deactivate() noexcept override;
  /// nothing_new until the next sample.
  Io read(ImuReading& reading) noexcept override;

 private:
  Board& board_;
  Lifecycle lifecycle_;
  std::uint64_t samples_read_ = 0;
};

class SimPoseSource : public PoseSource {
 public:
  explicit SimPoseSource(Board& board) : board_(board) {}
  Status configure() override;
  Status activate() override;
  void deactivate() noexcept override;
  /// nothing_new until the next measurement has arrived.
  Io read(PoseReading& reading) noexcept override;

 private:
  Board& board_;
  Lifecycle lifecycle_;
  std::uint64_t samples_read_ = 0;
};

}  // namespace eciton::hal::sim
