// In the order in which it is easiest to say what is wrong.
#include "services/radio/claim_guard.hpp"

#include <numeric>

namespace eciton::radio {
namespace {

bool is_id(std::uint32_t module) { return module >= 1 && module <= ClaimGuard::id_max; }

/// As a module makes its claims: it claims when its latch reports latched, and has counted from 1.
bool well_formed(const GuardedClaim& claim) {
  if (!is_id(claim.module) || claim.incarnation == 0 || claim.sequence_number == 0) return false;
  if (!claim.linked) return !claim.latched;
  return claim.latched && is_id(claim.peer) && claim.peer != claim.module;
}

}  // namespace

void ClaimGuard::hear_beacon(std::uint32_t module, std::uint64_t incarnation, std::uint64_t origin) noexcept {
  if (!is_id(module)) return;
  Radio& radio = radios_[module];
  if (radio.heard && incarnation <= radio.incarnation) return;
  radio = {.heard = true, .incarnation = incarnation, .origin = origin};
}

ClaimFault ClaimGuard::judge(const GuardedClaim& claim, std::uint64_t origin) const noexcept {
  if (!well_formed(claim)) return ClaimFault::malformed;
  if (claim.port >= config_.ports || (claim.linked && claim.peer_port >= config_.ports)) {
    return ClaimFault::no_such_port;
  }
  // What our own module claims does not come from outside.
  if (claim.module == config_.own_id) return ClaimFault::foreign_writer;
  const Radio& radio = radios_[claim.module];
  if (!radio.heard) return ClaimFault::unknown_module;
  if (radio.origin != 0 && origin != 0 && radio.origin != origin) return ClaimFault::foreign_writer;
  return ClaimFault::count;
}

std::uint64_t ClaimGuard::refused() const noexcept {
  return std::accumulate(refused_.begin(), refused_.end(), std::uint64_t{0});
}

}  // namespace eciton::radio
