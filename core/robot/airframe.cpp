// The numbers of the airframes that come with Eciton.
#include "core/robot/airframe.hpp"

namespace eciton::robot {
namespace {

constexpr double link_mass_kg = 0.23;

JointGeometry dock_joint(const Vector3& p_BJ_m, const Vector3& axis_B, const Vector3& p_JP_m) {
  return {.p_BJ_m = p_BJ_m,
          .axis_B = axis_B,
          .link_mass_kg = link_mass_kg,
          .p_JL_m = 0.5 * p_JP_m,
          .I_L_kg_m2 = Vector3::Constant(2e-4).asDiagonal(),
          .position_rad_max = 1.5,
          .rate_rad_s_max = 2.6,
          .torque_Nm_max = 5.0};
}

}  // namespace

Airframe legion(bool lidar) {
  // The LiDAR moves the centre of mass, so every point shifts by the same offset.
  const Vector3 shift_m = lidar ? Vector3(-.0016, -.0015, -.0063) : Vector3::Zero();
  Airframe a;
  a.name = lidar ? "legion-lidar" : "legion";
  a.mass_kg = lidar ? 4.177 : 3.915;
  if (lidar) {
    a.I_B_kg_m2 << .04453, .00262, -.00125, .00262, .14711, -.00054, -.00125, -.00054, .17719;
  } else {
    a.I_B_kg_m2 << .04178, .00277, -.00061, .00277, .14433, .00005, -.00061, .00005, .17676;
  }
  const auto rotor = [&](double x, double y, double z, double spin) {
    a.rotors.push_back({.p_BR_m = Vector3(x, y, z) + shift_m,
                        .drag_ratio_m = spin * 0.0172,
                        .thrust_N_min = 2.0,  // the data say 1; the thrust map was measured from 2 on
                        .thrust_N_max = 21.0,
                        .gimbal_rad_max = 2.0,
                        .gimbal_rate_rad_s_max = 3.0});
  };
  rotor(.0757, .1907, .0344, +1);
  rotor(.0757, -.1895, .0344, -1);
  rotor(-.1577, .0006, .0344, +1);

  const Vector3 p_male_joint_m(.2612, .0006, .0384), p_male_m(.4020, .0006, .0084);
  const Vector3 p_female_joint_m(-.3670, -.0244, .0094), p_female_m(-.4040, .0006, .0094);
  a.joints.push_back(dock_joint(p_male_joint_m + shift_m, Vector3::UnitZ(), p_male_m - p_male_joint_m));
  a.joints.push_back(dock_joint(p_female_joint_m + shift_m, Vector3::UnitY(), p_female_m - p_female_joint_m));
  a.ports.push_back({PortKind::male, 0, p_male_m - p_male_joint_m, Matrix3::Identity()});
  a.ports.push_back({PortKind::female, 1, p_female_m - p_female_joint_m, Matrix3::Identity()});
  return a;
}

}  // namespace eciton::robot
