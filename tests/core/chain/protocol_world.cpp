// The world's modules, radio and faults.
#include "tests/core/chain/protocol_world.hpp"

#include <algorithm>

namespace eciton::chain::test {
namespace {

/// For mutations: the claims that `keep` keeps, in a table whose revision has moved on, as after any change.
template <class Keep>
ClaimTable rebuilt(const ClaimTable& claims, std::uint64_t revision, const Keep& keep) {
  constexpr std::uint32_t nobody = 99;
  ClaimTable table;
  for (const Claim& claim : claims.entries()) {
    if (claim.module != nobody && keep(claim)) table.join(claim);
  }
  for (std::uint64_t k = 0; table.revision() <= revision; ++k)
    table.join(Claim{.module = nobody, .sequence_number = k});
  return table;
}

}  // namespace

World::World(const WorldConfig& config) : config_(config), random_(config.seed) {
  modules_.resize(static_cast<std::size_t>(2 + random(7)));
  loss_ = random() * 0.6;
  pace_ = 0.3 + random();
  clocks_known_ = random() < 0.8;
  for (std::size_t k = 0; k < modules_.size(); ++k) {
    Module& module = modules_[k];
    module.id = static_cast<std::uint32_t>(k + 1);
    module.clock = from_s(100 + 4 * random());  // up to 4 s apart
    module.could_hear.resize(modules_.size());
    module.offset_error.resize(modules_.size());
    for (auto& error : module.offset_error) {
      if (clocks_known_) error = from_s(0.002 * (2 * random() - 1));
    }
    start(module);
  }
}

void World::start(Module& module) {
  module.live = true;
  module.started = now_;
  if (config_.mutation != Mutation::restart_forgets || module.incarnation == 0) ++module.incarnation;
  module.claims_made = 0;
  module.claims = {};
  module.announcements = {};
  module.heard.assign(modules_.size(), Duration{-1h});
  module.flown.reset();
  module.once_active.clear();
  module.agreement.emplace(AgreementConfig{.module = module.id, .incarnation = module.incarnation}, rule_);
}

void World::cause_faults() {
  if (happens_per_s(8 * pace_)) try_dock();  // most pairs drawn cannot dock
  if (happens_per_s(0.8 * pace_)) undock();
  if (happens_per_s(1.5 * pace_)) crash_or_restart();
  if (happens_per_s(0.5 * pace_)) split_or_heal();
  if (happens_per_s(0.5 * pace_))
    modules_[random(static_cast<int>(modules_.size()))].muted_until = now_ + from_s(2 * random());
}

void World::try_dock() {
  const int n = static_cast<int>(modules_.size());
  const int a = random(n), b = random(n);  // male of a into female of b
  const auto together = component_of(a);
  if (std::count(together.begin(), together.end(), b) != 0) return;  // no rings
  Port& male = modules_[a].port[ChainRule::male_port];
  Port& female = modules_[b].port[ChainRule::female_port];
  for (const Port* port : {&male, &female}) {
    if (port->peer >= 0 || now_ - port->changed < 300ms) return;
  }
  if (!modules_[a].live || !modules_[b].live) return;
  male = {b, ChainRule::female_port, now_, from_s(0.15 * random()), modules_[b].id, ChainRule::female_port, false};
  female = {a, ChainRule::male_port, now_, from_s(0.15 * random()), modules_[a].id, ChainRule::male_port, false};
  ++result_.docked;
}

void World::undock() {
  Port& port = modules_[random(static_cast<int>(modules_.size()))].port[random(ports)];
  if (port.peer < 0) return;
  Port& other = modules_[port.peer].port[port.peer_port];
  for (Port* end : {&port, &other}) {
    end->peer = -1;
    end->changed = now_;
    end->latch_delay = from_s(0.15 * random());
  }
  ++result_.undocked;
}

void World::crash_or_restart() {
  Module& module = modules_[random(static_cast<int>(modules_.size()))];
  const bool all_live = std::all_of(modules_.begin(), modules_.end(), [](const Module& m) { return m.live; });
  const auto unsure = [](const Module& m) { return m.port[0].checkpoint_lost || m.port[1].checkpoint_lost; };
  if (!module.live) {
    start(module);
    // Two ends that both forget cannot know each other again; one that does asks the other's claims.
    const bool lost = random() < 0.3 && std::all_of(modules_.begin(), modules_.end(),
                                                    [&](const Module& m) { return m.live && !unsure(m); });
    for (Port& port : module.port) port.checkpoint_lost = lost && port.peer >= 0;
  } else if (all_live || random() < 0.3) {
    if (std::any_of(modules_.begin(), modules_.end(), unsure)) return;
    module.live = false;
    ++result_.crashed;
  }
}

void World::split_or_heal() {
  const bool split = std::all_of(modules_.begin(), modules_.end(), [](const Module& m) { return m.group == 0; });
  for (Module& module : modules_) module.group = split ? random(2) : 0;
  result_.partitions += split;
}

void World::stop_faults() {
  for (Module& module : modules_) {
    if (!module.live) start(module);
    module.group = 0;
  }
}

void World::deliver() {
  std::vector<Message> due;
  due.swap(in_flight_[slot_]);
  for (const Message& message : due) {
    Module& to = modules_[message.to];
    if (to.live && to.group == modules_[message.from].group) receive(to, message);
  }
}

void World::receive(Module& module, const Message& message) {
  module.heard[message.from] = now_;
  if (message.announcement) module.announcements.join(*message.announcement);
  if (!message.claim) return;
  if (config_.mutation == Mutation::last_arrival_wins) {
    if (const Claim* const kept = module.claims.Registers::find(message.claim->key());
        kept && *kept == *message.claim)
      return;
    module.claims = rebuilt(module.claims, module.claims.revision(),
                            [&](const Claim& claim) { return claim.key() != message.claim->key(); });
    module.claims.join(*message.claim);
  } else {
    module.claims.join(*message.claim);
  }
}

std::optional<Claim> World::claim_for(const Module& module, int port_number) const {
  const Port& port = module.port[port_number];
  if (now_ - port.changed < port.latch_delay) return std::nullopt;
  Claim claim{.module = module.id, .port = static_cast<std::uint32_t>(port_number)};
  if (port.peer < 0) return claim;
  claim.withdrawn = false;
  claim.latch = LatchStatus::latched;
  claim.peer = port.known_peer;
  claim.peer_port = port.known_peer_port;
  if (!port.checkpoint_lost) return claim;
  const Claim* const theirs = module.claims.claimant_of(module.id, claim.port);
  if (now_ - module.started < 500ms || theirs == nullptr) return std::nullopt;
  claim.peer = theirs->module;
  claim.peer_port = theirs->port;
  return claim;
}

void World::claim_what_latches_report(Module& module) {
  for (int k = 0; k < ports; ++k) {
    const auto wanted = claim_for(module, k);
    if (!wanted) continue;
    module.port[k].checkpoint_lost = false;
    module.port[k].known_peer = wanted->peer;
    module.port[k].known_peer_port = wanted->peer_port;
    const Claim* const standing = module.claims.find(module.id, wanted->port);
    if (standing != nullptr && standing->content() == wanted->content()) continue;
    Claim claim = *wanted;
    claim.incarnation = module.incarnation;
    claim.sequence_number = ++module.claims_made;
    module.claims.join(claim);
  }
}

std::vector<PeerStatus> World::peers_of(const Module& module) const {
  std::vector<PeerStatus> peers;
  for (std::size_t k = 0; k < modules_.size(); ++k) {
    if (modules_[k].id == module.id || module.heard[k] < Duration{}) continue;
    PeerStatus peer{
        .module = modules_[k].id, .fresh = is_fresh(now_ - module.heard[k], true, {}), .clock_offset = {}};
    if (config_.mutation == Mutation::never_silent) peer.fresh = true;
    if (module.offset_error[k]) peer.clock_offset = modules_[k].clock - module.clock + *module.offset_error[k];
    peers.push_back(peer);
  }
  return peers;
}

ClaimTable World::claims_without_silent(const Module& module, const std::vector<PeerStatus>& peers) const {
  return rebuilt(module.claims, static_cast<std::uint64_t>(now_ / tick), [&](const Claim& claim) {
    return std::none_of(peers.begin(), peers.end(),
                        [&](const PeerStatus& peer) { return peer.module == claim.module && !peer.fresh; });
  });
}

AnnouncementTable World::announcements_taken_for_granted(const Module& module) const {
  AnnouncementTable table;
  const auto& held = module.agreement->held();
  for (const Module& other : modules_)
    table.join(Announcement{.module = other.id, .epoch = held ? held->epoch : 0, .phase = ViewPhase::proposed});
  for (const Announcement& heard : module.announcements.entries()) {
    if (held && heard.epoch == held->epoch) table.join(heard);
  }
  return table;
}

void World::step(Module& module) {
  claim_what_latches_report(module);
  const auto peers = peers_of(module);
  const TimePoint clock{now_ + module.clock};
  if (config_.mutation == Mutation::silence_unlinks) {
    module.agreement->update(clock, claims_without_silent(module, peers), module.announcements, peers);
  } else if (config_.mutation == Mutation::takes_for_granted) {
    module.agreement->update(clock, module.claims, announcements_taken_for_granted(module), peers);
  } else {
    module.agreement->update(clock, module.claims, module.announcements, peers);
  }
  const Announcement& said = module.agreement->announcement();
  if (module.agreement->held()) announced_by_[said.epoch].insert(module.id);
}

void World::broadcast(int from) {
  const Module& module = modules_[from];
  std::vector<Message> messages;
  if (now_ >= module.muted_until) messages.push_back({from, 0, {}, module.agreement->announcement()});
  for (std::uint32_t port = 0; port < ports; ++port) {
    if (const Claim* const claim = module.claims.find(module.id, port)) messages.push_back({from, 0, *claim, {}});
  }
  for (int to = 0; to < static_cast<int>(modules_.size()); ++to) {
    if (to == from || modules_[to].group != module.group) continue;
    for (Message& message : messages) {
      message.to = to;
      for (int copies = random() < 0.1 ? 2 : 1; copies > 0; --copies) {
        const int delay = 1 + (random() < 0.2 ? random(delay_ticks_max) : random(2));
        if (random() >= loss_) in_flight_[(slot_ + delay) % in_flight_.size()].push_back(message);
      }
    }
  }
}

WorldResult World::run() {
  const Duration end = config_.faulty_for + 2 * config_.agreement_bound;
  for (; now_ < end && !result_.violation; now_ += tick) {
    if (now_ < config_.faulty_for) cause_faults();
    if (now_ == config_.faulty_for) stop_faults();
    deliver();
    for (int k = 0; k < static_cast<int>(modules_.size()); ++k) {
      Module& module = modules_[k];
      if (!module.live) continue;
      step(module);
      watch(module);
      if ((now_ / tick + k) % (broadcast_period / tick) == 0) broadcast(k);
    }
    note_disturbances();
    if (now_ % 50ms == Duration{}) watch_convergence();
    slot_ = (slot_ + 1) % in_flight_.size();
  }
  return result_;
}

}  // namespace eciton::chain::test
