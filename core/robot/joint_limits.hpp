// What joints may be asked: each within its own limit, no member of a chain tilted further against the base than
// its gimbals can hold, and no two members in each other's way.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/robot/kinematics.hpp"

namespace eciton::robot {

enum class LimitKind { count, not_finite, position, rate, chain_tilt, collision };

/// Why a goal is refused.
struct LimitFault {
  LimitKind kind = LimitKind::position;
  std::size_t member = 0;  // index in the chain
  std::size_t joint = 0;   // index in the member; collision: of the other member in the chain
  double value = 0;
  double limit = 0;

  /// Writes what is wrong and what would be right, cut to `size` with its end; returns `text`.
  const char* describe(char* text, std::size_t size) const;
};

/// Beyond this tilt against the base gimbals run into their limits before thrust does. Measured with LEGION's
/// airframe in simulation: with the branch rule of the allocation; 1.1 rad without.
inline constexpr double chain_tilt_rad_max = 1.4;

/// `position_rad` holds the joints of one or more members, one member after another.
std::optional<LimitFault> check_positions(const Airframe& airframe, std::span<const double> position_rad);
std::optional<LimitFault> check_rate(const Airframe& airframe, double rate_rad_s);

/// Greatest angle between a member's z axis and the base's; along a chain that bends in pitch alone, the
/// greatest sum of pitch angles counted from the base. With the base level it is the tilt of the member.
struct ChainTilt {
  std::size_t member = 0;
  double tilt_rad = 0;
};
ChainTilt chain_tilt(const Airframe& airframe, std::size_t base, std::span<const double> position_rad);

/// On the straight way in joint space from one set of positions to another, both ends included.
std::optional<LimitFault> check_chain_tilt(const Airframe& airframe, std::size_t base,
                                           std::span<const double> from_rad, std::span<const double> to_rad,
                                           double tilt_rad_max = chain_tilt_rad_max);

/// On the same way: the members that would come too near to each other.
std::optional<LimitFault> check_chain_collision(const Airframe& airframe, std::span<const double> from_rad,
                                                std::span<const double> to_rad);

}  // namespace eciton::robot
