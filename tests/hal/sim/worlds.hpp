// Worlds that several tests of the simulation begin with.
#pragma once

#include "core/robot/kinematics.hpp"
#include "core/robot/thrust_map.hpp"
#include "hal/sim/world.hpp"

namespace eciton::hal::sim {

constexpr TimePoint at_ms(std::int64_t ms) { return from_ns(1'000'000 * ms); }

constexpr double still_battery_V = 24.2;

/// No model errors, no noise, no wind, no wakes: what a pencil can compute.
inline WorldConfig still_world() {
  WorldConfig config;
  config.world = "ideal";
  config.wakes = false;
  config.noise = 0;
  config.battery = {.start_V = still_battery_V, .discharge_V_min = 0, .sag_V = 0, .noise_V = 0};
  return config;
}

/// LEGION's port in B, joints at zero.
inline robot::Pose legion_port(int port) {
  const std::array<double, 2> zero{};
  return robot::port_pose_B(robot::legion(), port, zero);
}

/// Module 1 at 1.5 m height and module 2 before it, so that 2's female docking point lies at `p_PF_m` from
/// 1's male one, in its axes, and 2 is turned by `yaw_rad`. Both hover.
inline std::vector<ModuleStart> nose_to_tail(const robot::Vector3& p_PF_m, double yaw_rad = 0) {
  const robot::Vector3 p_W = robot::Vector3(0, 0, 1.5) + legion_port(0).p + p_PF_m;
  const robot::Vector3 p_WB = p_W - robot::exp_so3({0, 0, yaw_rad}) * legion_port(1).p;
  return {{.id = 1, .p_WB_m = {0, 0, 1.5}, .hovering = true},
          {.id = 2, .p_WB_m = {p_WB.x(), p_WB.y(), p_WB.z()}, .yaw_rad = yaw_rad, .hovering = true}};
}

/// The throttle that makes this thrust, as a hardware host would send it.
inline void set_thrust(ActuatorFrame& frame, std::size_t rotor, double thrust_N, double battery_V = still_battery_V) {
  static const robot::ThrustMap map = robot::thrust_map(robot::legion());
  frame.rotors[rotor].thrust_N = thrust_N;
  frame.throttle_percent[rotor] = map.percent(thrust_N, battery_V);
}

inline ActuatorFrame hover_frame(LatchCommand latch) {
  ActuatorFrame frame;
  frame.armed = frame.joints_powered = true;
  for (std::size_t k = 0; k < 3; ++k) set_thrust(frame, k, robot::legion().hover_thrust_N());
  frame.latches = {latch, latch, LatchCommand::hold, LatchCommand::hold};
  return frame;
}

}  // namespace eciton::hal::sim
