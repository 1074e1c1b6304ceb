// An airframe for tests only: four ports that look to +x, +y, -x, -y; opposite ports link; rings are no rings here.
#pragma once

#include "core/chain/structure.hpp"

namespace eciton::chain::test {

/// Members are ordered row by row, on the grid in which the least member is at the origin.
class LatticeRule : public StructureRule {
 public:
  static constexpr std::uint32_t opposite(std::uint32_t port) { return (port + 2) % 4; }
  Refusal arrange(std::span<const std::uint32_t> members, std::span<const Link> links,
                  Structure& structure) const override;
};

}  // namespace eciton::chain::test
