// A small autopilot for tests of the simulated world: flies a module on the truth, so that a test of the
// physics depends on no service.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "core/robot/kinematics.hpp"
#include "hal/sim/world.hpp"
#include "tests/hal/sim/worlds.hpp"

namespace eciton::hal::sim {

class Pilot {
 public:
  Pilot(World& world, std::uint32_t module) : world_(world), module_(module) {
    frame.armed = frame.joints_powered = true;
    goal = world.truth_pose(module).p_WM_m;
  }

  robot::Vector3 goal;  // for M
  robot::Vector3 goal_velocity = robot::Vector3::Zero();
  double integral_gain = 4;  // of position; of attitude twice that
  ActuatorFrame frame;       // latches and joints are the test's to set

  /// Once per 2 ms.
  void act() {
    const robot::Airframe& airframe = world_.airframe();
    const TruthPose x = world_.truth_pose(module_);
    const robot::Matrix3& R = x.X_WB.R;
    std::array<double, 2> joint_rad{world_.truth_joint(module_, 0).position_rad,
                                    world_.truth_joint(module_, 1).position_rad};
    const robot::Vector3 error = goal - x.p_WM_m;
    integral_ += 0.002 * error;
    const robot::Vector3 force_W =
        airframe.mass_kg * (20 * error + 8 * (goal_velocity - x.v_WM_m_s) + integral_gain * integral_ +
                            robot::gravity_m_s2 * robot::Vector3::UnitZ());
    const robot::Vector3 turn = -robot::log_so3(R);
    turn_integral_ += 0.002 * turn;
    const robot::Matrix3 I = robot::composite_inertia(airframe, joint_rad);
    const robot::Vector3 moment_B = I * (60 * (R.transpose() * turn) +
                                         2 * integral_gain * (R.transpose() * turn_integral_) - 14 * x.w_WM_M_rad_s);
    allocate(R.transpose() * force_W, moment_B, robot::com_offset_B(airframe, joint_rad));
    world_.actuate(module_, frame);
  }

 private:
  void allocate(const robot::Vector3& force_B, const robot::Vector3& moment_B, const robot::Vector3& c_B) {
    const robot::Airframe& airframe = world_.airframe();
    Eigen::Matrix<double, 6, 9> Q;
    for (int k = 0; k < 3; ++k) {
      const robot::RotorGeometry& rotor = airframe.rotors[static_cast<std::size_t>(k)];
      Q.block<3, 3>(0, 3 * k).setIdentity();
      Q.block<3, 3>(3, 3 * k) = robot::skew(rotor.p_BR_m - c_B) + rotor.drag_ratio_m * robot::Matrix3::Identity();
    }
    robot::Vector6 wanted;
    wanted << force_B, moment_B;
    const double battery_V = world_.sense(module_).rotors[0].battery_V;
    const Eigen::Matrix<double, 9, 1> lambda = Q.transpose() * (Q * Q.transpose()).ldlt().solve(wanted);
    for (std::size_t k = 0; k < 3; ++k) {
      const robot::Vector3 l = lambda.segment<3>(3 * static_cast<int>(k));
      const double phi = std::atan2(-l.y(), l.z());
      set_thrust(frame, k, l.norm(), battery_V);
      frame.rotors[k].gimbal_rad = {phi, std::atan2(l.x(), -l.y() * std::sin(phi) + l.z() * std::cos(phi))};
    }
  }

  World& world_;
  std::uint32_t module_;
  robot::Vector3 integral_ = robot::Vector3::Zero();
  robot::Vector3 turn_integral_ = robot::Vector3::Zero();
};

/// Flies all pilots for `duration_s`, calling `each_tick(time since the beginning, s)` before each 2 ms.
template <class EachTick>
void fly(World& world, std::vector<Pilot>& pilots, double duration_s, EachTick each_tick) {
  const TimePoint begin = world.now();
  while (world.now() < begin + from_s(duration_s)) {
    each_tick(to_s(world.now() - begin));
    for (Pilot& pilot : pilots) pilot.act();
    world.advance(world.now() + 2ms);
  }
}
inline void fly(World& world, std::vector<Pilot>& pilots, double duration_s) {
  fly(world, pilots, duration_s, [](double) {});
}

}  // namespace eciton::hal::sim
