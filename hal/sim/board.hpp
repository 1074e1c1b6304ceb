// The one "board" behind a simulated module's five devices: the readings that came in last and the
// commands that go out next. A link fills and empties it; one thread uses it.
#pragma once

#include <cstdint>

#include "hal/sim/frames.hpp"

namespace eciton::hal::sim {

class Board {
 public:
  const SensorFrame& sensors() const { return sensors_; }
  ActuatorFrame& actuators() { return actuators_; }
  const ActuatorFrame& actuators() const { return actuators_; }

  /// For links: new readings are in. Real-time safe.
  void set_sensors(const SensorFrame& frame) {
    sensors_ = frame;
    ++frames_received_;
  }
  /// Counts the frames received: a device knows by it whether there is anything new.
  std::uint64_t frames_received() const { return frames_received_; }

 private:
  SensorFrame sensors_;
  ActuatorFrame actuators_;
  std::uint64_t frames_received_ = 0;
};

}  // namespace eciton::hal::sim
