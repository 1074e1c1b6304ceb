// Checks of joint goals.
#include "core/robot/joint_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/robot/chain_clearance.hpp"

namespace eciton::robot {

const char* LimitFault::describe(char* text, std::size_t size) const {
  const std::size_t m = member + 1;
  switch (kind) {
    case LimitKind::count:
      std::snprintf(text, size, "%.0f joint positions given; this chain has %.0f joints", value, limit);
      break;
    case LimitKind::not_finite:
      std::snprintf(text, size, "member %zu, joint %zu: the position is not a number", m, joint);
      break;
    case LimitKind::position:
      std::snprintf(text, size, "member %zu, joint %zu: %.3f rad is beyond its limit of %.3f rad", m, joint, value,
                    limit);
      break;
    case LimitKind::rate:
      std::snprintf(text, size, "joint rate %.3f rad/s; it must be above 0 and at most %.3f rad/s", value, limit);
      break;
    case LimitKind::chain_tilt:
      std::snprintf(text, size, "member %zu would tilt %.3f rad against the base; at most %.3f rad is flyable", m,
                    value, limit);
      break;
    case LimitKind::collision:
      std::snprintf(text, size, "members %zu and %zu would touch on the way: less than %.3f m between them", m,
                    joint + 1, limit);
      break;
  }
  return text;
}

std::optional<LimitFault> check_positions(const Airframe& airframe, std::span<const double> position_rad) {
  const std::size_t n = airframe.joints.size();
  const std::size_t members = n > 0 ? position_rad.size() / n : 0;
  if (n == 0 || position_rad.empty() || position_rad.size() % n != 0 || members > members_max) {
    const std::size_t right = n * std::clamp<std::size_t>(members, 1, members_max);
    return LimitFault{LimitKind::count, 0, 0, static_cast<double>(position_rad.size()), static_cast<double>(right)};
  }
  for (std::size_t k = 0; k < position_rad.size(); ++k) {
    const double limit = airframe.joints[k % n].position_rad_max;
    if (!std::isfinite(position_rad[k])) return LimitFault{LimitKind::not_finite, k / n, k % n, 0, limit};
    if (std::abs(position_rad[k]) > limit + 1e-9) {
      return LimitFault{LimitKind::position, k / n, k % n, position_rad[k], limit};
    }
  }
  return std::nullopt;
}

std::optional<LimitFault> check_rate(const Airframe& airframe, double rate_rad_s) {
  double limit = 1e9;
  for (const JointGeometry& joint : airframe.joints) limit = std::min(limit, joint.rate_rad_s_max);
  if (rate_rad_s > 0 && rate_rad_s <= limit) return std::nullopt;
  return LimitFault{LimitKind::rate, 0, 0, rate_rad_s, limit};
}

ChainTilt chain_tilt(const Airframe& airframe, std::size_t base, std::span<const double> position_rad) {
  const std::size_t n = airframe.joints.size();
  const std::size_t members = n > 0 ? std::min(position_rad.size() / n, members_max) : 0;
  ChainTilt worst;
  if (base >= members || airframe.ports.size() < 2) return worst;
  std::array<Pose, members_max> X;
  chain_poses(airframe, base, {}, position_rad, std::span(X).first(members));
  for (std::size_t i = 0; i < members; ++i) {
    const Vector3 up = X[i].R.col(2);
    const double tilt = std::atan2(up.head<2>().norm(), up.z());
    if (tilt > worst.tilt_rad) worst = {i, tilt};
  }
  return worst;
}

std::optional<LimitFault> check_chain_tilt(const Airframe& airframe, std::size_t base,
                                           std::span<const double> from_rad, std::span<const double> to_rad,
                                           double tilt_rad_max) {
  // Pitch sums are linear on the way and greatest at its ends; with yaw between them they need not be.
  constexpr int parts = 16;
  std::array<double, coordinates_max> between{};
  const std::size_t size = std::min({from_rad.size(), to_rad.size(), between.size()});
  // A chain already bent further may be straightened.
  const double limit = std::max(tilt_rad_max, chain_tilt(airframe, base, from_rad.first(size)).tilt_rad);
  for (int k = parts; k > 0; --k) {
    for (std::size_t i = 0; i < size; ++i) between[i] = from_rad[i] + (to_rad[i] - from_rad[i]) * k / parts;
    const ChainTilt worst = chain_tilt(airframe, base, std::span(between).first(size));
    if (worst.tilt_rad > limit + 1e-9) {
      return LimitFault{LimitKind::chain_tilt, worst.member, 0, worst.tilt_rad, tilt_rad_max};
    }
  }
  return std::nullopt;
}

std::optional<LimitFault> check_chain_collision(const Airframe& airframe, std::span<const double> from_rad,
                                                std::span<const double> to_rad) {
  const ChainClearanceConfig config;
  const auto near = check_chain_clearance(airframe, from_rad, to_rad, config);
  if (!near) return std::nullopt;
  return LimitFault{LimitKind::collision, near->first, near->second, near->clearance_m, config.clearance_m};
}

}  // namespace eciton::robot
