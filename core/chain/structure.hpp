// The seam between links and airframes: a structure rule says what a set of linked modules is.
// LEGION's makes chains; a lattice of four-port modules is another implementation of the same interface.
#pragma once

#include <span>
#include <string_view>

#include "core/chain/link_graph.hpp"

namespace eciton::chain {

struct Structure {
  BoundedVector<std::uint32_t, max_modules> members;  // in the structure's order
  BoundedVector<Link, max_links> links;               // in the structure's order and orientation
};

enum class Refusal : std::uint8_t {
  none,
  ring,             // the members close on themselves
  forbidden_ports,  // a link joins ports that do not fit each other
  inconsistent,     // the links fit no place in the structure
  too_large         // more than `max_modules` members
};
std::string_view to_text(Refusal refusal);

class StructureRule {
 public:
  virtual ~StructureRule() = default;
  /// Arranges one connected component: `members` by rising id, `links` among them, the lesser end first.
  /// The result depends on these alone, so that all modules come to the same one. Real-time safe.
  virtual Refusal arrange(std::span<const std::uint32_t> members, std::span<const Link> links,
                          Structure& structure) const = 0;
};

/// LEGION: port 0 is male, port 1 female. Members are numbered from the one whose female port is free;
/// the male port of member i sits in the female port of member i+1. Links run from male to female.
class ChainRule : public StructureRule {
 public:
  static constexpr std::uint32_t male_port = 0;
  static constexpr std::uint32_t female_port = 1;
  Refusal arrange(std::span<const std::uint32_t> members, std::span<const Link> links,
                  Structure& structure) const override;
};

}  // namespace eciton::chain
