// What a robot module is made of: masses, rotors, joints, ports. An airframe is data; a new robot is a
// new value of this struct. Frame B: body axes at the nominal centre of mass (joints at zero).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/robot/frames.hpp"

namespace eciton::robot {

// Bounds of everything that is sized once and for all.
inline constexpr std::size_t rotors_max = 8;    // of one module
inline constexpr std::size_t joints_max = 8;    // of one module
inline constexpr std::size_t members_max = 16;  // of one chain

struct RotorGeometry {
  Vector3 p_BR_m;
  double drag_ratio_m;  // drag torque / thrust, signed: positive for spin +
  double thrust_N_min;
  double thrust_N_max;
  double gimbal_rad_max;  // of phi and theta; 0: fixed, thrust along body z
  double gimbal_rate_rad_s_max;
};

/// A dock joint between the body and a dock link.
struct JointGeometry {
  Vector3 p_BJ_m;
  Vector3 axis_B;  // unit
  double link_mass_kg;
  Vector3 p_JL_m;           // centre of mass of the link, joint at zero
  Matrix3 I_L_kg_m2;        // of the link about its centre of mass
  double position_rad_max;  // symmetric limit
  double rate_rad_s_max;
  double torque_Nm_max;
};

enum class PortKind { male, female };

/// A docking point, fixed on the link of one joint.
struct PortGeometry {
  PortKind kind;
  int joint;       // index into joints
  Vector3 p_JP_m;  // joint at zero
  Matrix3 R_JP;    // x out of a male port, into a female one: linked ports have equal axes
};

struct Airframe {
  std::string name;
  double mass_kg;     // all of it, links included
  Matrix3 I_B_kg_m2;  // of all of it about B's origin, joints at zero
  std::vector<RotorGeometry> rotors;
  std::vector<JointGeometry> joints;
  std::vector<PortGeometry> ports;

  double hover_thrust_N() const { return mass_kg * gravity_m_s2 / static_cast<double>(rotors.size()); }
};

/// LEGION's module, without or with its LiDAR: 3 rotors on two-axis gimbals, joint 0 yaw at the male
/// end, joint 1 pitch at the female end. Source: the authors' public robot description.
Airframe legion(bool lidar = false);

}  // namespace eciton::robot
