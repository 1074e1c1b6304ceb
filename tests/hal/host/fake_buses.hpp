// Buses that misbehave on demand, and count as the hal asks its backends to.
#pragma once

#include "hal/interfaces.hpp"

namespace eciton::hal {

/// Powered or not, it refuses to activate.
class DeadRotorBus final : public RotorBus {
 public:
  Status configure() override { return ok(); }
  Status activate() override { return Error{"no board answers"}; }
  void deactivate() noexcept override {}
  Io write(std::span<const RotorSetpoint>) noexcept override { return Io::error; }
  Io read(std::span<RotorReading>) noexcept override { return Io::error; }
};

class FlakyJointBus final : public JointBus {
 public:
  Status configure() override { return ok(); }
  Status activate() override { return ok(); }
  void deactivate() noexcept override {}
  Io write(std::span<const JointSetpoint> commands) noexcept override {
    ++writes;
    if (broken) return ++errors, Io::timeout;
    first_rad = commands.front().position_rad;
    return Io::ok;
  }
  Io read(std::span<JointReading> states) noexcept override {
    ++reads;
    if (broken) return ++errors, Io::error;
    states.front().position_rad = first_rad;
    return Io::ok;
  }

  bool broken = false;
  int writes = 0, reads = 0, errors = 0;
  double first_rad = 0;
};

}  // namespace eciton::hal
