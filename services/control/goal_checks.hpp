// What a flight goal may ask: numbers that are numbers, places inside the geofence, attitudes that can be held, a
// speed and a start that make sense. A refusal names the field, where it stands and what would be right. Pure.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/robot/hover_reach.hpp"
#include "core/robot/trajectory.hpp"
#include "services/control/separation.hpp"

namespace eciton::control {

struct GoalLimits {
  Fence fence;
  double height_m_min = 0.3;  // of a goal
  double speed_m_s_max = 2;
  double start_ahead_s_max = 60;
};

/// Why a goal is refused, in words; fits an answer's reason.
struct GoalFault {
  std::array<char, 128> text{};
};

/// Finite, and a rotation.
bool is_pose(const std::array<double, 3>& p_WM_m, const std::array<double, 4>& q_WM);
/// `waypoint`: its number in a path, from 1; 0: the goal itself.
std::optional<GoalFault> check_pose(const std::array<double, 3>& p_WM_m, const std::array<double, 4>& q_WM,
                                    std::size_t waypoint, const GoalLimits& limits);
/// Straight up from `p_WM`.
std::optional<GoalFault> check_takeoff(const robot::Vector3& p_WM, double height_m, const GoalLimits& limits);
/// 0 means the default.
std::optional<GoalFault> check_speed(double speed_m_s, const GoalLimits& limits);
std::optional<GoalFault> check_start(double ahead_s, const GoalLimits& limits);

/// One moment of a way, of all members or of a module alone: inside the fence, and attitudes that can be held.
/// `height_m_low`: how low it may go. `com_offset_B` is of this module and stands for all.
std::optional<GoalFault> check_moment(std::span<const robot::PoseReference> members, double height_m_low,
                                      const GoalLimits& limits, const robot::Vector3& com_offset_B,
                                      robot::HoverReach& reach);

}  // namespace eciton::control
