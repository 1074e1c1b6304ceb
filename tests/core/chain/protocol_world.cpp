// The world's modules and radio.
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

World::World(const Schedule& schedule, const WorldConfig& config)
    : schedule_(schedule),
      config_(config),
      ports_(schedule.airframe == Airframe::chain ? 2 : 4),
      rule_(schedule.airframe == Airframe::chain ? static_cast<const StructureRule&>(chain_rule_) : lattice_rule_) {
  modules_.resize(static_cast<std::size_t>(schedule_.modules));
  for (std::size_t k = 0; k < modules_.size(); ++k) {
    Module& module = modules_[k];
    module.id = static_cast<std::uint32_t>(k + 1);
    module.clock = from_s(100) + Duration(chance(k, 0, 1) % 4'000'000'000u);  // up to 4 s apart
    module.could_hear.resize(modules_.size());
    module.offset_error.resize(modules_.size());
    for (std::size_t other = 0; other < modules_.size(); ++other) {
      if (schedule_.clocks_known) module.offset_error[other] = Duration(chance(k, other, 2) % 4'000'000u) - 2ms;
    }
    start(module);
  }
  find_components();
}

std::uint64_t World::chance(std::uint64_t a, std::uint64_t b, std::uint64_t c) const {
  std::uint64_t z = schedule_.seed * 0x9e3779b97f4a7c15u + ((a << 40) ^ (b << 20) ^ c);
  for (int k = 0; k < 2; ++k) {  // SplitMix64's finaliser
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
  }
  return z;
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
  module.agreement.emplace(
      AgreementConfig{
          .module = module.id, .incarnation = module.incarnation, .ports = static_cast<std::uint32_t>(ports_)},
      rule_);
}

void World::deliver() {
  std::vector<Message>& due = in_flight_[slot_];
  for (const Message& message : due) {
    Module& to = modules_[message.to];
    if (to.live && to.group == modules_[message.from].group) receive(to, message);
  }
  due.clear();
}

void World::receive(Module& module, const Message& message) {
  module.heard[message.from] = now_;
  const Saying& said = said_[message.said];
  if (const auto* announcement = std::get_if<Announcement>(&said)) {
    module.announcements.join(*announcement);
    return;
  }
  const Claim& claim = *std::get_if<Claim>(&said);
  if (config_.mutation == Mutation::last_arrival_wins) {
    if (const Claim* const kept = module.claims.Registers::find(claim.key()); kept && *kept == claim) return;
    module.claims = rebuilt(module.claims, module.claims.revision(),
                            [&](const Claim& other) { return other.key() != claim.key(); });
  }
  module.claims.join(claim);
}

std::optional<Claim> World::claim_for(const Module& module, int port_number) const {
  const Port& port = module.port[port_number];
  if (now_ - port.changed < port.latch_delay) return std::nullopt;
  Claim claim{.module = module.id, .port = static_cast<std::uint32_t>(port_number)};
  if (now_ < port.false_until) {
    claim.withdrawn = false;
    claim.latch = LatchStatus::latched;
    claim.peer = modules_[port.false_peer].id;
    claim.peer_port = static_cast<std::uint32_t>(port.false_peer_port);
    return claim;
  }
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
  for (int k = 0; k < ports_; ++k) {
    const auto wanted = claim_for(module, k);
    if (!wanted) continue;
    module.port[k].checkpoint_lost = false;
    if (module.port[k].peer >= 0) {
      module.port[k].known_peer = wanted->peer;
      module.port[k].known_peer_port = wanted->peer_port;
    }
    const Claim* const standing = module.claims.find(module.id, wanted->port);
    if (standing != nullptr && standing->content() == wanted->content()) continue;
    Claim claim = *wanted;
    claim.incarnation = module.incarnation;
    claim.sequence_number = ++module.claims_made;
    module.claims.join(claim);
  }
}

void World::look_at_peers(Module& module) {
  module.peers.clear();
  for (std::size_t k = 0; k < modules_.size(); ++k) {
    if (modules_[k].id == module.id || module.heard[k] < Duration{}) continue;
    PeerStatus peer{
        .module = modules_[k].id, .fresh = is_fresh(now_ - module.heard[k], true, {}), .clock_offset = {}};
    if (config_.mutation == Mutation::never_silent) peer.fresh = true;
    if (module.offset_error[k]) peer.clock_offset = modules_[k].clock - module.clock + *module.offset_error[k];
    module.peers.push_back(peer);
  }
}

ClaimTable World::claims_without_silent(const Module& module) const {
  return rebuilt(module.claims, static_cast<std::uint64_t>(now_ / tick), [&](const Claim& claim) {
    return std::none_of(module.peers.begin(), module.peers.end(),
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
  look_at_peers(module);
  const std::span<const PeerStatus> peers{module.peers.data(), module.peers.size()};
  const TimePoint clock{now_ + module.clock};
  if (config_.mutation == Mutation::silence_unlinks) {
    module.agreement->update(clock, claims_without_silent(module), module.announcements, peers);
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
  const std::size_t first = said_.size();
  if (now_ >= module.muted_until) said_.emplace_back(module.agreement->announcement());
  for (std::uint32_t port = 0; port < static_cast<std::uint32_t>(ports_); ++port) {
    if (const Claim* const claim = module.claims.find(module.id, port)) said_.emplace_back(*claim);
  }
  const auto lost_below = static_cast<std::uint64_t>(schedule_.loss * 0x1p24);
  for (int to = 0; to < static_cast<int>(modules_.size()); ++to) {
    if (to == from || modules_[to].group != module.group) continue;
    for (std::size_t k = first; k < said_.size(); ++k) {
      std::uint64_t luck =
          chance(static_cast<std::uint64_t>(now_ / tick), static_cast<std::uint64_t>(from * 16 + to), 3 + k - first);
      for (int copies = luck % 10 == 0 ? 2 : 1; copies > 0; --copies, luck = luck * 0xd1342543de82ef95u + 1) {
        const bool far = (luck >> 8) % 5 == 0;
        const int delay = 1 + static_cast<int>((luck >> 16) % (far ? delay_ticks_max : 2));
        if ((luck >> 40) >= lost_below)
          in_flight_[(slot_ + static_cast<std::size_t>(delay)) % in_flight_.size()].push_back({from, to, k});
      }
    }
  }
}

WorldResult World::run() {
  const Duration end = schedule_.faulty_for + 2 * config_.agreement_bound;
  const Duration faulty_for = schedule_.faulty_for / tick * tick;
  for (; now_ < end && !result_.violation; now_ += tick) {
    for (; next_event_ < schedule_.events.size() && schedule_.events[next_event_].at <= now_; ++next_event_) {
      if (now_ < faulty_for) apply(schedule_.events[next_event_]);
    }
    if (now_ == faulty_for) stop_faults();
    deliver();
    for (int k = 0; k < static_cast<int>(modules_.size()); ++k) {
      Module& module = modules_[k];
      if (!module.live) continue;
      step(module);
      watch(module);
      if ((now_ / tick + k) % (broadcast_period / tick) == 0) broadcast(k);
    }
    note_disturbances();
    watch_convergence();
    slot_ = (slot_ + 1) % in_flight_.size();
  }
  return result_;
}

}  // namespace eciton::chain::test
