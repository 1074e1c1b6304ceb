// Every claim a module has heard, its own included: one register per module and port.
// Silence takes nothing out of it. A restarted module's old claims stay until it claims or withdraws anew.
#pragma once

#include "core/chain/claim.hpp"
#include "core/chain/registers.hpp"

namespace eciton::chain {

class ClaimTable : public Registers<Claim, max_modules * max_ports> {
 public:
  const Claim* find(std::uint32_t module, std::uint32_t port) const {
    return Registers::find(std::tuple(module, port));
  }

  /// The one claim that names this port as its peer; nullptr if there is none, or more than one. It tells a
  /// module that restarted, finds its latch closed and has no checkpoint, who is in its port.
  const Claim* claimant_of(std::uint32_t module, std::uint32_t port) const;
};

}  // namespace eciton::chain
