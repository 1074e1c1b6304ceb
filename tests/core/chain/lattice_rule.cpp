// Walks the links over the grid, until every member has a cell of its own.
#include "tests/core/chain/lattice_rule.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace eciton::chain::test {

Refusal LatticeRule::arrange(std::span<const std::uint32_t> members, std::span<const Link> links,
                             Structure& structure) const {
  structure.members.clear();
  structure.links.clear();
  std::map<std::uint32_t, std::pair<int, int>> cell{{members[0], {0, 0}}};
  for (std::size_t round = 0; round < members.size(); ++round) {
    for (const Link& forward : links) {
      for (const Link& l : {forward, forward.reversed()}) {
        if (opposite(l.port) != l.peer_port) return Refusal::forbidden_ports;
        if (cell.count(l.module) == 0) continue;
        constexpr int dx[] = {1, 0, -1, 0}, dy[] = {0, 1, 0, -1};
        const auto [x, y] = cell[l.module];
        const std::pair to{x + dx[l.port], y + dy[l.port]};
        if (!cell.emplace(l.peer, to).second && cell[l.peer] != to) return Refusal::inconsistent;
      }
    }
  }
  std::set<std::pair<int, int>> taken;
  for (const auto& [module, at] : cell) {
    if (!taken.insert(at).second) return Refusal::inconsistent;
    structure.members.push_back(module);
  }
  std::sort(structure.members.begin(), structure.members.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(cell[a].second, cell[a].first) < std::pair(cell[b].second, cell[b].first);
  });
  for (const Link& l : links) structure.links.push_back(l.port < 2 ? l : l.reversed());
  return Refusal::none;
}

}  // namespace eciton::chain::test
