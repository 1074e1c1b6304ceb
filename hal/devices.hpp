// The devices of one module, owned by its hardware host. A factory makes them from the config's `hal` key.
#pragma once

#include <memory>
#include <vector>

#include "hal/interfaces.hpp"

namespace eciton::hal {

struct Devices {
  std::unique_ptr<RotorBus> rotors;
  std::unique_ptr<JointBus> joints;
  std::vector<std::unique_ptr<Latch>> latches;  // port by port
  std::unique_ptr<Imu> imu;
  std::unique_ptr<PoseSource> pose;
  std::size_t rotor_count = 0;
  std::size_t joint_count = 0;
  bool armed = false;  // rotors powered: set by the actuator side, told by the sensor side

  /// Calls `visit` on every device, in the order above.
  template <class Visit>
  void for_each(Visit&& visit) {
    visit(*rotors);
    visit(*joints);
    for (auto& latch : latches) visit(*latch);
    visit(*imu);
    visit(*pose);
  }
};

}  // namespace eciton::hal
