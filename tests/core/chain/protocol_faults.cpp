// What a schedule's events do to the world, where they can happen.
#include <algorithm>
#include <map>

#include "tests/core/chain/protocol_world.hpp"

namespace eciton::chain::test {

void World::apply(const Event& event) {
  Module& module = modules_[event.a];
  switch (event.kind) {
    case EventKind::dock:
      return dock(event);
    case EventKind::undock:
      return undock(event);
    case EventKind::crash:
      return crash(module);
    case EventKind::restart:
      return restart(module, event.flag);
    case EventKind::split:
      for (std::size_t k = 0; k < modules_.size(); ++k) modules_[k].group = (event.b >> k) & 1;
      ++result_.partitions;
      return;
    case EventKind::heal:
      for (Module& m : modules_) m.group = 0;
      return;
    case EventKind::mute:
      module.muted_until = now_ + event.span;
      return;
    case EventKind::claim_falsely:
      return claim_falsely(event);
  }
}

bool World::fits_the_grid(int a, int a_port, int b) const {
  constexpr int dx[] = {1, 0, -1, 0}, dy[] = {0, 1, 0, -1};
  std::map<int, std::pair<int, int>> cell{{a, {0, 0}}};
  const auto place = [&](int first) {
    std::vector<int> open{first};
    for (std::size_t k = 0; k < open.size(); ++k) {
      for (int port = 0; port < ports_; ++port) {
        const int peer = modules_[open[k]].port[port].peer;
        const auto [x, y] = cell[open[k]];
        if (peer >= 0 && cell.emplace(peer, std::pair(x + dx[port], y + dy[port])).second) open.push_back(peer);
      }
    }
  };
  place(a);
  const std::pair at_b{dx[a_port], dy[a_port]};
  if (cell.count(b) != 0) return cell[b] == at_b;
  cell[b] = at_b;
  place(b);
  std::set<std::pair<int, int>> taken;
  return std::all_of(cell.begin(), cell.end(), [&](const auto& c) { return taken.insert(c.second).second; });
}

void World::dock(const Event& event) {
  const int a = event.a, b = event.b;
  if (a == b) return;
  const bool chain = schedule_.airframe == Airframe::chain;
  const int a_port = event.port;
  const int b_port = chain ? 1 - a_port : static_cast<int>(LatticeRule::opposite(static_cast<std::uint32_t>(a_port)));
  Port& one = modules_[a].port[a_port];
  Port& other = modules_[b].port[b_port];
  for (const Port* port : {&one, &other}) {
    if (port->peer >= 0 || now_ - port->changed < 300ms || now_ < port->false_until) return;
  }
  if (!modules_[a].live || !modules_[b].live) return;
  // A chain may bite its tail now and then; a lattice has to stay one.
  if (chain ? component_at_[a] == component_at_[b] && event.span > 15ms : !fits_the_grid(a, a_port, b)) return;
  one.peer = b;
  one.peer_port = b_port;
  other.peer = a;
  other.peer_port = a_port;
  for (Port* port : {&one, &other}) {
    port->changed = now_;
    port->latch_delay = port == &one ? event.span : event.other_span;
    port->known_peer = modules_[port->peer].id;
    port->known_peer_port = static_cast<std::uint32_t>(port->peer_port);
    port->checkpoint_lost = false;
  }
  const Link link{modules_[a].id, other.known_peer_port, modules_[b].id, one.known_peer_port};
  ever_linked_.insert(link);
  ever_linked_.insert(link.reversed());
  ++result_.docked;
  find_components();
}

void World::undock(const Event& event) {
  Port& port = modules_[event.a].port[event.port];
  if (port.peer < 0) return;
  Port& other = modules_[port.peer].port[port.peer_port];
  for (Port* end : {&port, &other}) {
    end->peer = -1;
    end->changed = now_;
    end->latch_delay = end == &port ? event.span : event.other_span;
  }
  ++result_.undocked;
  find_components();
}

bool World::anyone_unsure() const {
  return std::any_of(modules_.begin(), modules_.end(), [](const Module& module) {
    return std::any_of(module.port.begin(), module.port.end(), [](const Port& port) { return port.checkpoint_lost; });
  });
}

void World::crash(Module& module) {
  if (!module.live || anyone_unsure()) return;
  module.live = false;
  ++result_.crashed;
}

void World::restart(Module& module, bool checkpoint_lost) {
  if (module.live) return;
  start(module);
  // Two ends that both forget cannot know each other again; one that does asks the other's claims, which must not
  // be a false one's then.
  const auto can_tell = [&](const Module& m) {
    return m.live && std::all_of(m.port.begin(), m.port.end(), [&](const Port& p) { return now_ >= p.false_until; });
  };
  if (!checkpoint_lost || anyone_unsure() || !std::all_of(modules_.begin(), modules_.end(), can_tell)) return;
  for (Port& port : module.port) port.checkpoint_lost = port.peer >= 0;
}

void World::claim_falsely(const Event& event) {
  Port& port = modules_[event.a].port[event.port];
  const auto false_already = [&](const Module& m) {
    return std::any_of(m.port.begin(), m.port.end(), [&](const Port& p) { return now_ < p.false_until; });
  };
  // One at a time: two that lie to match are believed.
  if (port.peer >= 0 || now_ - port.changed < 300ms || event.a == event.b || anyone_unsure() ||
      std::any_of(modules_.begin(), modules_.end(), false_already))
    return;
  port.false_peer = event.b;
  port.false_peer_port = schedule_.airframe == Airframe::chain
                             ? 1 - event.port
                             : static_cast<int>(LatticeRule::opposite(static_cast<std::uint32_t>(event.port)));
  port.false_until = now_ + event.span;
  ++result_.false_claims;
}

void World::stop_faults() {
  for (Module& module : modules_) {
    if (!module.live) start(module);
    module.group = 0;
    for (Port& port : module.port) port.false_until = std::min(port.false_until, now_);
  }
}

}  // namespace eciton::chain::test
