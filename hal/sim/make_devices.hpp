// The simulated devices of one module on its board.
#pragma once

#include "core/robot/airframe.hpp"
#include "hal/devices.hpp"
#include "hal/sim/devices.hpp"

namespace eciton::hal::sim {

inline Devices make_devices(Board& board, const robot::Airframe& airframe, bool battery_compensation = true) {
  Devices devices;
  devices.rotor_count = airframe.rotors.size();
  devices.joint_count = airframe.joints.size();
  devices.rotors =
      std::make_unique<SimRotorBus>(board, devices.rotor_count, robot::thrust_map(airframe), battery_compensation);
  devices.joints = std::make_unique<SimJointBus>(board, devices.joint_count);
  for (std::size_t port = 0; port < airframe.ports.size(); ++port) {
    devices.latches.push_back(std::make_unique<SimLatch>(board, port));
  }
  devices.imu = std::make_unique<SimImu>(board);
  devices.pose = std::make_unique<SimPoseSource>(board);
  return devices;
}

}  // namespace eciton::hal::sim
