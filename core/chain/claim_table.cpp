// Questions asked of the claims.
#include "core/chain/claim_table.hpp"

namespace eciton::chain {

const Claim* ClaimTable::claimant_of(std::uint32_t module, std::uint32_t port) const {
  const Claim* found = nullptr;
  for (const Claim& claim : entries()) {
    if (!claim.names(module, port)) continue;
    if (found != nullptr) return nullptr;
    found = &claim;
  }
  return found;
}

}  // namespace eciton::chain
