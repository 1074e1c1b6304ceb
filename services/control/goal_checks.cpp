// Goals against their limits.
#include "services/control/goal_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <limits>

namespace eciton::control {

using robot::Vector3;

namespace {

__attribute__((format(printf, 1, 2))) GoalFault fault(const char* format, ...) {
  GoalFault out;
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(out.text.data(), out.text.size(), format, arguments);
  va_end(arguments);
  return out;
}

constexpr char axis_name(int axis) { return "xyz"[axis]; }

/// The axis along which it is outside, or none.
std::optional<int> outside(const Vector3& p_W, double height_m_low, const Fence& fence) {
  for (int k = 0; k < 3; ++k) {
    const double low = k == 2 ? height_m_low : fence.low_W[k];
    if (!(p_W[k] >= low && p_W[k] <= fence.high_W[k])) return k;
  }
  return std::nullopt;
}

double low_of(int axis, double height_m_low, const Fence& fence) {
  return axis == 2 ? height_m_low : fence.low_W[axis];
}

double lowest(const GoalLimits& limits) { return std::max(limits.height_m_min, limits.fence.low_W.z()); }

}  // namespace

bool is_pose(const std::array<double, 3>& p_WM_m, const std::array<double, 4>& q_WM) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const Fence everywhere{Vector3::Constant(-inf), Vector3::Constant(inf)};
  return !check_pose(p_WM_m, q_WM, 0, {.fence = everywhere, .height_m_min = -inf});
}

std::optional<GoalFault> check_pose(const std::array<double, 3>& p_WM_m, const std::array<double, 4>& q_WM,
                                    std::size_t waypoint, const GoalLimits& limits) {
  std::array<char, 40> where{};
  if (waypoint > 0) std::snprintf(where.data(), where.size(), "waypoint %zu: ", waypoint);
  double squares = 0;
  for (const double q : q_WM) squares += q * q;
  const Vector3 p_W(p_WM_m[0], p_WM_m[1], p_WM_m[2]);
  if (!p_W.allFinite()) return fault("%sp_WM_m is not finite", where.data());
  if (!std::isfinite(squares)) return fault("%sq_WM is not finite", where.data());
  if (std::abs(std::sqrt(squares) - 1) > 0.01) {
    return fault("%sq_WM has length %.4g; a rotation has 1", where.data(), std::sqrt(squares));
  }
  if (const auto axis = outside(p_W, lowest(limits), limits.fence)) {
    return fault("%s%c %.5g m is outside the fence: %.4g to %.4g m", where.data(), axis_name(*axis), p_W[*axis],
                 low_of(*axis, lowest(limits), limits.fence), limits.fence.high_W[*axis]);
  }
  return std::nullopt;
}

std::optional<GoalFault> check_takeoff(const Vector3& p_WM, double height_m, const GoalLimits& limits) {
  if (!std::isfinite(height_m)) return fault("the height is not finite");
  const double low = std::max(lowest(limits), p_WM.z());
  if (height_m < low || height_m > limits.fence.high_W.z()) {
    return fault("height %.5g m; from here %.4g to %.4g m may be asked", height_m, low, limits.fence.high_W.z());
  }
  if (const auto axis = outside({p_WM.x(), p_WM.y(), height_m}, low, limits.fence)) {
    return fault("stands outside the fence: %c %.5g m, which is %.4g to %.4g m", axis_name(*axis), p_WM[*axis],
                 limits.fence.low_W[*axis], limits.fence.high_W[*axis]);
  }
  return std::nullopt;
}

std::optional<GoalFault> check_speed(double speed_m_s, const GoalLimits& limits) {
  if (speed_m_s >= 0 && speed_m_s <= limits.speed_m_s_max) return std::nullopt;
  return fault("speed_m_s %.5g; it must be at most %.4g, above 0, or 0 for the default", speed_m_s,
               limits.speed_m_s_max);
}

std::optional<GoalFault> check_start(double ahead_s, const GoalLimits& limits) {
  if (ahead_s <= limits.start_ahead_s_max) return std::nullopt;
  return fault("start_ns is %.5g s ahead; at most %.4g s", ahead_s, limits.start_ahead_s_max);
}

std::optional<GoalFault> check_moment(std::span<const robot::PoseReference> members, double height_m_low,
                                      const GoalLimits& limits, const Vector3& com_offset_B,
                                      robot::HoverReach& reach) {
  for (std::size_t i = 0; i < members.size(); ++i) {
    std::array<char, 40> who{};
    if (members.size() > 1) std::snprintf(who.data(), who.size(), "member %zu: ", i + 1);
    const Vector3& p_W = members[i].p_WM;
    if (const auto axis = outside(p_W, height_m_low, limits.fence)) {
      return fault("%son the way %c %.5g m is outside the fence: %.4g to %.4g m", who.data(), axis_name(*axis),
                   p_W[*axis], low_of(*axis, height_m_low, limits.fence), limits.fence.high_W[*axis]);
    }
    if (!reach.holds(members[i].R_WM, com_offset_B)) {
      const Vector3 up = members[i].R_WM.col(2);
      return fault("%sa tilt of %.3g rad this way is more than its gimbals and rotors can hold", who.data(),
                   std::atan2(up.head<2>().norm(), up.z()));
    }
  }
  return std::nullopt;
}

}  // namespace eciton::control
