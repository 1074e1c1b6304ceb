// How one simulated module differs from the airframe that its controllers believe in.
#pragma once

#include <array>

#include "core/robot/airframe.hpp"
#include "hal/sim/frames.hpp"
#include "hal/sim/random.hpp"

namespace eciton::hal::sim {

struct Mismatch {
  std::array<double, max_rotors> thrust_scale;  // true thrust / thrust of the nominal model
  double mass_scale = 1;
  robot::Vector3 second_moment_scale = robot::Vector3::Ones();  // of the mass distribution, per body axis
  robot::Vector3 p_B_com_m = robot::Vector3::Zero();            // true centre of mass, joints at zero
  robot::Vector3 attitude_bias_rad = robot::Vector3::Zero();    // of the pose sensor, body axes
  std::array<double, max_joints> joint_offset_rad{};            // encoder reading less true angle

  Mismatch() { thrust_scale.fill(1.0); }
};

/// The preset "honest": thrust to 5 % per rotor, mass and inertia to 3 %, centre of mass to 3 % of the
/// least radius of gyration, attitude bias to 10 mrad, joint offset to 20 mrad, all uniform.
/// `full_joint_offset`: + 20 mrad each.
Mismatch draw_mismatch(const robot::Airframe& airframe, Random random, bool full_joint_offset = false);

/// Mass and inertia of a module's main body and its links, as the physics engine wants them.
struct TrueInertia {
  double body_mass_kg;
  robot::Vector3 p_B_body_com_m;
  robot::Matrix3 I_body_kg_m2;  // about the body's own centre of mass
  double link_scale;            // of the links' mass and inertia
};
TrueInertia true_inertia(const robot::Airframe& airframe, const Mismatch& mismatch);

}  // namespace eciton::hal::sim
