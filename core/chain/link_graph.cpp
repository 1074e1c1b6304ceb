// Pairs of claims become links.
#include "core/chain/link_graph.hpp"

#include <algorithm>
#include <optional>

namespace eciton::chain {
namespace {

bool claims_module_from_another_port(const ClaimTable& claims, const Claim& claim) {
  return std::any_of(claims.entries().begin(), claims.entries().end(), [&](const Claim& other) {
    return other.module == claim.peer && other.holds() && other.peer == claim.module;
  });
}

std::optional<ContradictionKind> contradiction_in(const ClaimTable& claims, const Claim& claim) {
  if (claim.peer == claim.module) return ContradictionKind::self;
  if (claims_module_from_another_port(claims, claim)) return ContradictionKind::ports_mismatch;
  const Claim* const answer = claims.find(claim.peer, claim.peer_port);
  if (answer != nullptr && answer->holds()) return ContradictionKind::port_taken;
  if (claims.claimant_of(claim.peer, claim.peer_port) == nullptr) return ContradictionKind::claimed_twice;
  return std::nullopt;
}

bool contains(const BoundedVector<std::uint32_t, max_modules>& members, std::uint32_t module) {
  return std::find(members.begin(), members.end(), module) != members.end();
}

}  // namespace

LinkGraph build_link_graph(const ClaimTable& claims) {
  LinkGraph graph;
  for (const Claim& claim : claims.entries()) {
    if (!claim.holds()) continue;
    const Claim* const answer = claims.find(claim.peer, claim.peer_port);
    if (answer != nullptr && answer->names(claim.module, claim.port) && claim.peer != claim.module) {
      if (claim.key() < answer->key()) graph.links.push_back({claim.module, claim.port, claim.peer, claim.peer_port});
    } else if (const auto kind = contradiction_in(claims, claim)) {
      graph.contradictions.push_back({*kind, claim});
    }
  }
  return graph;
}

bool component_of(std::uint32_t module, const LinkGraph& graph, BoundedVector<std::uint32_t, max_modules>& members) {
  members.clear();
  members.push_back(module);
  bool fits = true;
  for (std::size_t k = 0; k < members.size(); ++k) {
    for (const Link& link : graph.links) {
      if (link.module != members[k] && link.peer != members[k]) continue;
      const std::uint32_t other = link.module == members[k] ? link.peer : link.module;
      if (!contains(members, other)) fits &= members.push_back(other);
    }
  }
  std::sort(members.begin(), members.end());
  return fits;
}

}  // namespace eciton::chain
