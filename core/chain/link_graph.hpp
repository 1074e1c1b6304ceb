// From claims to links: a link exists when both ends claim each other, port for port.
// Claims that contradict one another make no link and are reported.
#pragma once

#include <compare>

#include "core/chain/claim_table.hpp"

namespace eciton::chain {

struct Link {
  std::uint32_t module = 0;
  std::uint32_t port = 0;
  std::uint32_t peer = 0;
  std::uint32_t peer_port = 0;

  auto operator<=>(const Link&) const = default;
  Link reversed() const { return {peer, peer_port, module, port}; }
};

enum class ContradictionKind : std::uint8_t {
  self,            // a module claims itself
  port_taken,      // the claimed port claims another one
  ports_mismatch,  // both modules claim each other, but not the same pair of ports
  claimed_twice    // two modules claim a port that claims neither
};

struct Contradiction {
  ContradictionKind kind;
  Claim claim;  // the one that makes no link
};

struct LinkGraph {
  BoundedVector<Link, max_links> links;  // the lesser (module, port) first, in that order
  BoundedVector<Contradiction, max_modules> contradictions;
};

/// A stray claim on a port never undoes the link of that port: no third module can cut a chain in flight.
/// A claim whose peer has not answered yet makes no link and is no contradiction. Real-time safe.
LinkGraph build_link_graph(const ClaimTable& claims);

/// The modules joined to `module` by links, itself included, by rising id. False: they are more than `max_modules`.
bool component_of(std::uint32_t module, const LinkGraph& graph, BoundedVector<std::uint32_t, max_modules>& members);

}  // namespace eciton::chain
