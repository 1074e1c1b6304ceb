// Whether a docking can be asked for at all, and which ports it takes: what is known before anything moves.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/bounded.hpp"
#include "services/docking/port_relation.hpp"

namespace eciton::docking {

/// What the follower knows of a module of either side.
struct Candidate {
  std::uint32_t module = 0;
  bool known = false;  // a beacon or state of it was ever heard
  bool fresh = false;
  bool flying = false;
  bool docking = false;  // with anyone, in either role
  bool zeroed = false;   // its wrench observer's bias was measured
};

enum class DockRefusal : std::uint8_t {
  none,
  same_module,
  unknown_module,
  silent,
  landed,
  already_docking,
  not_zeroed,
  unsettled,   // its chain is being agreed on
  ring,        // the two are in one chain
  ports_taken  // no free port of one fits a free port of the other
};

struct DockAnswer {
  DockRefusal refusal = DockRefusal::none;
  std::uint32_t module = 0;  // the one it is about
  /// The reason for people: names the module and what would be right.
  BoundedString<127> text() const;
};

/// One side of a docking: the module that was named first, then the rest of its chain.
using Side = std::span<const Candidate>;

/// `same_chain`: both are members of one view. `ports_fit`: choose_ports found a pair. The first reason counts;
/// the modules that were named are judged before their chain mates.
DockAnswer refuse_dock(Side follower, Side target, bool same_chain, bool ports_fit);

/// A port that no one holds, of the module itself or of a member at the end of its chain.
struct FreePort {
  std::uint32_t module = 0;
  std::uint32_t port = 0;
  PortKind kind = PortKind::male;
  Pose X_WP;  // x out of a male port, into a female one
};

struct PortChoice {
  FreePort follower;
  FreePort target;
};

/// Of all pairs of a male and a female port, one from each side, the one with the shortest way from the
/// follower's port to the standoff in front of the target's; ties fall to the first. Nothing: none fits.
std::optional<PortChoice> choose_ports(std::span<const FreePort> follower, std::span<const FreePort> target,
                                       double standoff_m);

}  // namespace eciton::docking
