// Whether the members of a chain come too near to each other: each is a few capsules, its spine from joint to joint
// and a ball about every rotor, its dock links thin ones. Linked members' links and spines touch by design; between
// them only rotors count.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/robot/kinematics.hpp"

namespace eciton::robot {

struct ChainClearanceConfig {
  double rotor_radius_m = 0.10;  // of the guards
  double spine_radius_m = 0.06;
  double link_radius_m = 0.04;
  double clearance_m = 0.03;  // between surfaces, at the least
  int steps_max = 300;        // of a motion's check: a motion that would need more is too close
};

/// The two members that are nearest to each other, by their surfaces.
struct Nearness {
  std::size_t first = 0;  // indices in the chain
  std::size_t second = 0;
  double clearance_m = 1e9;  // negative: they overlap
};

/// In one posture; `joint_rad` holds the members' joints one after another.
Nearness chain_clearance(const Airframe& airframe, std::span<const double> joint_rad,
                         const ChainClearanceConfig& config = {});

/// On the straight way in joint space, both ends included: nothing, or the members that come too near. Steps are as
/// long as the room there is allows, so that nothing is stepped over. A chain that is too close already may open.
/// Real-time safe; bounded by `steps_max` postures.
std::optional<Nearness> check_chain_clearance(const Airframe& airframe, std::span<const double> from_rad,
                                              std::span<const double> to_rad,
                                              const ChainClearanceConfig& config = {});

/// Distance between two segments.
double segment_distance_m(const Vector3& a0, const Vector3& a1, const Vector3& b0, const Vector3& b1);

}  // namespace eciton::robot
