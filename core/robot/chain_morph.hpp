// What a chain's joints may be asked for. Control's references and the joints' own trajectories must agree to
// the letter, so both ask here.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/base/bounded.hpp"
#include "core/robot/minimum_jerk.hpp"

namespace eciton::robot {

inline constexpr double morph_rate_rad_s_default = 0.12;
inline constexpr double morph_rate_rad_s_max = 0.5;
inline constexpr double morph_acceleration_rad_s2 = 0.5;
/// Pitch summed along a chain from its base: beyond it gimbals bind before thrust does.
inline constexpr double chain_pitch_rad_max = 1.4;

/// 0: the default; never over the greatest.
double morph_rate_rad_s(double asked_rad_s);

/// Why a chain of so many members cannot take these joint positions (member by member, in the order of the
/// chain); nothing: it can.
std::optional<BoundedString<127>> refuse_morph(const Airframe& airframe, std::size_t members,
                                               std::span<const double> joint_rad);

/// From where the joints are referenced now to the positions, all in one time.
JointMotion plan_morph(const JointMotion& now, std::span<const double> joint_rad, double rate_rad_s, double start_s);

}  // namespace eciton::robot
