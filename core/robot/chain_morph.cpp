// Limits and plans of a chain's joints.
#include "core/robot/chain_morph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace eciton::robot {
namespace {

BoundedString<127> text(const char* format, std::size_t a, std::size_t b, double x, double y) {
  std::array<char, 128> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, a, b, x, y);
  return BoundedString<127>(buffer.data());
}

}  // namespace

double morph_rate_rad_s(double asked_rad_s) {
  return asked_rad_s > 0 ? std::min(asked_rad_s, morph_rate_rad_s_max) : morph_rate_rad_s_default;
}

std::optional<BoundedString<127>> refuse_morph(const Airframe& airframe, std::size_t members,
                                               std::span<const double> joint_rad) {
  const std::size_t each = airframe.joints.size();
  if (joint_rad.size() != members * each) {
    return text("%zu joint positions for a chain of %zu members with %.0f joints each", joint_rad.size(), members,
                static_cast<double>(each), 0);
  }
  double pitch_rad = 0, pitch_rad_min = 0, pitch_rad_max = 0;
  for (std::size_t i = 0; i < members; ++i) {
    for (std::size_t k = 0; k < each; ++k) {
      const JointGeometry& joint = airframe.joints[k];
      const double angle_rad = joint_rad[i * each + k];
      if (!(std::abs(angle_rad) <= joint.position_rad_max)) {
        return text("member %zu, joint %zu: %.2f rad is beyond its limit of %.2f", i + 1, k, angle_rad,
                    joint.position_rad_max);
      }
      // The first member's own female side leads nowhere.
      if (i > 0 && std::abs(joint.axis_B.y()) > 0.5) pitch_rad += angle_rad;
    }
    pitch_rad_min = std::min(pitch_rad_min, pitch_rad);
    pitch_rad_max = std::max(pitch_rad_max, pitch_rad);
  }
  if (pitch_rad_max - pitch_rad_min > chain_pitch_rad_max) {
    return text("member %zu of %zu: pitch along the chain sums to %.2f rad, its limit is %.2f", members, members,
                pitch_rad_max - pitch_rad_min, chain_pitch_rad_max);
  }
  return std::nullopt;
}

JointMotion plan_morph(const JointMotion& now, std::span<const double> joint_rad, double rate_rad_s, double start_s) {
  std::array<ScalarMotion, coordinates_max> from;
  now.at(start_s, std::span(from).first(joint_rad.size()));
  JointMotion motion;
  motion.go(std::span<const ScalarMotion>(from).first(joint_rad.size()), joint_rad, start_s,
            morph_rate_rad_s(rate_rad_s), morph_acceleration_rad_s2);
  return motion;
}

}  // namespace eciton::robot
