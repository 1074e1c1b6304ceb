// Contact wrenches between the members of a chain from the external wrenches they share, (8) to (10) of
// LEGION with a consistent common disturbance: then the constrained least-squares solution is a running sum
// that every member does by itself. All wrenches in world axes.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/robot/airframe.hpp"
#include "core/robot/freshness.hpp"

namespace eciton::estimation {

/// What one member shares, or shared last. Members stand in the order of the chain.
struct MemberWrench {
  bool known = false;  // heard of since the chain formed
  double age_s = 0;
  robot::Wrench external_W;                                // about r
  robot::Vector3 r_W = robot::Vector3::Zero();             // composite centre of mass
  robot::Vector3 port_to_next_W = robot::Vector3::Zero();  // docking point towards the next member (male)
  robot::Vector3 port_to_last_W = robot::Vector3::Zero();  // towards the one before (female)
};

struct MemberContact {
  robot::Vector3 r_W = robot::Vector3::Zero();     // as it says; never heard of: straight on from its neighbour
  robot::Wrench d_W;                               // external less common wrench, about r
  robot::Vector3 link_W = robot::Vector3::Zero();  // P to the next member: midway between what both say
  robot::Wrench contact_W;                         // of this member on the next, about P; zero for the last one
  double freshness = 0;
  double link_freshness = 0;  // of both ends' together: how far contact_W is to be believed
};

/// What is of the whole chain.
struct ChainWrench {
  robot::Wrench common_W;  // mean force, and total moment about mean_r_W by the number of members
  robot::Vector3 mean_r_W = robot::Vector3::Zero();
  std::size_t fresh = 0;  // members that count fully
  bool complete = false;  // every member known
};

struct ContactWrenches : ChainWrench {
  std::size_t count = 0;
  std::array<MemberContact, robot::members_max> members{};
};

/// Rule for silent members: a member's last wrench is held and its *difference from the common one* fades
/// with its age, so that a silent member ends up as one that feels no contact, and what the others feel still
/// adds up to nothing. With weights f_k (1 while fresh):
///   D_k = the share of member k in the common disturbance of all f_k (W_k) (core/robot/chain_disturbance.hpp),
///   d_k = f_k (W_k - D_k),         c_k = -X(r_mean - P_k) sum_{j<=k} X(r_j - r_mean) d_j.
/// A member never heard of is one that is silent for ever: the others estimate among themselves, and what its links
/// carry is a guess, marked by their freshness. (d is the same about any r_mean, so a guessed place does no harm.)
/// Real-time safe, pure. A chain of any length, in time linear in it; `contacts` has a place for each member.
ChainWrench solve_contacts(std::span<const MemberWrench> members, std::span<MemberContact> contacts,
                           const robot::FreshnessConfig& config = {});
/// At most members_max members are looked at.
ContactWrenches contact_wrenches(std::span<const MemberWrench> members, const robot::FreshnessConfig& config = {});

}  // namespace eciton::estimation
