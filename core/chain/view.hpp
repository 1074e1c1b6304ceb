// A view: the structure a module takes itself to be in, and the epoch that identifies it. Modules that
// hold the same claims hold the same view, with the same epoch.
#pragma once

#include "core/chain/structure.hpp"

namespace eciton::chain {

struct View {
  BoundedVector<std::uint32_t, max_modules> members;  // in the structure's order
  BoundedVector<Link, max_links> links;
  std::uint32_t base = 0;   // member (n+1)/2, counted from 1
  std::uint64_t epoch = 0;  // 0: a single module, which needs nobody's agreement

  bool operator==(const View&) const = default;
  bool contains(std::uint32_t module) const;
};

/// The view of `module` that follows from the claims; on a refusal `view` is left alone. Real-time safe.
Refusal view_of(std::uint32_t module, const ClaimTable& claims, const LinkGraph& graph, const StructureRule& rule,
                View& view);

/// The identity of a structure, never 0 and never used twice: it is taken over the version of every claim
/// the members have made, withdrawn ones included, and of the claims these point at. Versions only grow, so a
/// structure that was left and formed again, even with old links untouched, has a new epoch.
std::uint64_t epoch_of(const BoundedVector<std::uint32_t, max_modules>& members, const ClaimTable& claims);

}  // namespace eciton::chain
