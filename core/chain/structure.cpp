// LEGION's chains.
#include "core/chain/structure.hpp"

#include <algorithm>

namespace eciton::chain {
namespace {

constexpr auto male = ChainRule::male_port;
constexpr auto female = ChainRule::female_port;

/// The link out of a module's male port, oriented so.
bool find_link_from(std::span<const Link> links, std::uint32_t module, Link& found) {
  for (const Link& link : links) {
    found = link.port == male ? link : link.reversed();
    if (found.module == module) return true;
  }
  return false;
}

bool female_is_free(std::span<const Link> links, std::uint32_t module) {
  return std::none_of(links.begin(), links.end(), [&](const Link& link) {
    return (link.module == module && link.port == female) || (link.peer == module && link.peer_port == female);
  });
}

}  // namespace

std::string_view to_text(Refusal refusal) {
  switch (refusal) {
    case Refusal::none:
      return "none";
    case Refusal::ring:
      return "the links close to a ring";
    case Refusal::forbidden_ports:
      return "a link joins two ports that do not fit each other";
    case Refusal::inconsistent:
      return "the links fit no place in the structure";
    case Refusal::too_large:
      return "more than 16 modules are linked";
  }
  return "unknown";
}

Refusal ChainRule::arrange(std::span<const std::uint32_t> members, std::span<const Link> links,
                           Structure& structure) const {
  structure.members.clear();
  structure.links.clear();
  for (const Link& link : links) {
    if (std::minmax(link.port, link.peer_port) != std::minmax(male, female)) return Refusal::forbidden_ports;
  }
  const auto first = std::find_if(members.begin(), members.end(),
                                  [&](std::uint32_t module) { return female_is_free(links, module); });
  if (first == members.end()) return Refusal::ring;
  structure.members.push_back(*first);
  Link link;
  while (structure.members.size() < members.size() && find_link_from(links, structure.members.back(), link)) {
    structure.links.push_back(link);
    structure.members.push_back(link.peer);
  }
  return structure.members.size() == members.size() ? Refusal::none : Refusal::inconsistent;
}

}  // namespace eciton::chain
