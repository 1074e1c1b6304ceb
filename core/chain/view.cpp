// Views and their epochs.
#include "core/chain/view.hpp"

#include <algorithm>

namespace eciton::chain {
namespace {

/// Folds one word into a hash; the finaliser of SplitMix64 (Steele, Lea, Flood 2014), a bijection.
std::uint64_t fold(std::uint64_t hash, std::uint64_t word) {
  std::uint64_t z = (hash ^ word) + 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

std::uint64_t fold_claim(std::uint64_t hash, const Claim& claim) {
  hash = fold(hash, (std::uint64_t{claim.module} << 32) | claim.port);
  hash = fold(hash, claim.incarnation);
  hash = fold(hash, claim.sequence_number);
  if (!claim.holds()) return fold(hash, 0);
  return fold(fold(hash, 1), (std::uint64_t{claim.peer} << 32) | claim.peer_port);
}

}  // namespace

bool View::contains(std::uint32_t module) const {
  return std::find(members.begin(), members.end(), module) != members.end();
}

std::uint64_t epoch_of(const BoundedVector<std::uint32_t, max_modules>& members, const ClaimTable& claims) {
  std::uint64_t hash = members.size();
  for (const Claim& claim : claims.entries()) {
    if (std::find(members.begin(), members.end(), claim.module) == members.end()) continue;
    hash = fold_claim(hash, claim);
    if (!claim.holds()) continue;
    const Claim* const answer = claims.find(claim.peer, claim.peer_port);
    hash = answer != nullptr ? fold_claim(hash, *answer) : fold(hash, 0);
  }
  return hash != 0 ? hash : 1;
}

Refusal view_of(std::uint32_t module, const ClaimTable& claims, const LinkGraph& graph, const StructureRule& rule,
                View& view) {
  BoundedVector<std::uint32_t, max_modules> members;
  if (!component_of(module, graph, members)) return Refusal::too_large;
  BoundedVector<Link, max_links> links;
  for (const Link& link : graph.links) {
    if (std::find(members.begin(), members.end(), link.module) != members.end()) links.push_back(link);
  }
  Structure structure;
  const Refusal refusal = rule.arrange({members.data(), members.size()}, {links.data(), links.size()}, structure);
  if (refusal != Refusal::none) return refusal;
  view.members = structure.members;
  view.links = structure.links;
  view.base = view.members[(view.members.size() + 1) / 2 - 1];
  view.epoch = view.members.size() > 1 ? epoch_of(members, claims) : 0;
  return Refusal::none;
}

}  // namespace eciton::chain
