// Between the topics of chain formation and its pure logic.
#include "services/docking/membership_service.hpp"

#include <algorithm>

namespace eciton::docking {
namespace {

chain::Claim from_message(const msg::LinkClaim& m) {
  return {.module = m.module_id,
          .port = m.port,
          .peer = m.peer_id,
          .peer_port = m.peer_port,
          .withdrawn = m.withdrawn,
          .latch = static_cast<chain::LatchStatus>(m.latch),
          .incarnation = m.incarnation,
          .sequence_number = m.sequence_number};
}

msg::LinkClaim to_message(const chain::Claim& c, TimePoint now) {
  msg::LinkClaim out;
  out.module_id = c.module;
  out.port = c.port;
  out.stamp_ns = to_ns(now);
  out.incarnation = c.incarnation;
  out.sequence_number = c.sequence_number;
  out.withdrawn = c.withdrawn;
  out.peer_id = c.peer;
  out.peer_port = c.peer_port;
  out.latch = static_cast<msg::LatchStatus>(c.latch);
  return out;
}

chain::Announcement from_message(const msg::ChainView& m) {
  return {.module = m.module_id,
          .incarnation = m.incarnation,
          .sequence_number = m.sequence_number,
          .epoch = m.epoch,
          .phase = static_cast<chain::ViewPhase>(m.phase),
          .start = from_ns(m.start_ns)};
}

}  // namespace

Membership::Membership(bus::Participant& ring, const MembershipConfig& config)
    : config_(config),
      agreement_({.module = config.module_id,
                  .incarnation = config.incarnation,
                  .ports = config.ports,
                  .start_margin = from_s(config.start_margin_s)},
                 rule_),
      latch_state_(ring.create_reader(topics::latch_state)),
      link_claims_(ring.create_reader(topics::link_claim)),
      chain_views_(ring.create_reader(topics::chain_view)),
      link_claim_(ring.create_writer(topics::link_claim)),
      chain_view_(ring.create_writer(topics::chain_view)) {}

void Membership::expect(std::uint32_t port, std::uint32_t peer, std::uint32_t peer_port) {
  latches_[port].peer = peer;
  latches_[port].peer_port = peer_port;
}

void Membership::update(TimePoint now, std::span<const chain::PeerStatus> peers) noexcept {
  take(now);
  if (!started_) started_ = now;
  for (std::uint32_t port = 0; port < config_.ports; ++port) claim(port, now);
  agreement_.update(now, claims_, announcements_, peers);
  publish(now);
}

void Membership::take(TimePoint) noexcept {
  while (const auto sample = latch_state_.take()) {
    const msg::LatchState& s = sample->value;
    if (s.module_id != config_.module_id || s.port >= config_.ports) continue;
    latches_[s.port].known = true;
    latches_[s.port].status = static_cast<chain::LatchStatus>(s.status);
  }
  while (const auto sample = link_claims_.take()) {
    const chain::Claim claim = from_message(sample->value);
    if (claim.module == config_.module_id) continue;
    if (possible(claim)) {
      claims_.join(claim);
    } else {
      ++claims_refused_;
    }
  }
  while (const auto sample = chain_views_.take()) {
    if (sample->value.module_id != config_.module_id) announcements_.join(from_message(sample->value));
  }
}

bool Membership::possible(const chain::Claim& claim) const noexcept {
  if (claim.module == 0 || claim.port >= config_.ports) return false;
  if (claim.withdrawn) return true;
  return claim.latch == chain::LatchStatus::latched && claim.peer != 0 && claim.peer != claim.module &&
         claim.peer_port < config_.ports;
}

void Membership::claim(std::uint32_t port, TimePoint now) noexcept {
  Latch& latch = latches_[port];
  if (!latch.known) return;
  chain::Claim claim{.module = config_.module_id, .port = port, .latch = latch.status};
  if (latch.status == chain::LatchStatus::latched) {
    if (latch.peer == 0) {
      // After a restart: whoever claims this port is in it. An old claim that comes late must not win.
      if (now - *started_ < from_s(config_.listen_s)) return;
      const chain::Claim* claimant = claims_.claimant_of(config_.module_id, port);
      if (claimant == nullptr) return;
      latch.peer = claimant->module;
      latch.peer_port = claimant->port;
    }
    claim.withdrawn = false;
    claim.peer = latch.peer;
    claim.peer_port = latch.peer_port;
  } else if (own_[port].holds()) {
    latch.peer = latch.peer_port = 0;  // it was linked and is open now: whoever comes next is expected anew
  }
  const chain::Claim& before = own_[port];
  const bool same = before.module != 0 && before.withdrawn == claim.withdrawn && before.peer == claim.peer &&
                    before.peer_port == claim.peer_port;  // open or ready: no link either way, and no new version
  if (same) return;
  claim.incarnation = config_.incarnation;
  claim.sequence_number = ++sequence_number_;
  own_[port] = claim;
  claims_.join(claim);
}

void Membership::publish(TimePoint now) noexcept {
  const bool repeat = now >= repeat_due_;
  if (repeat) repeat_due_ = now + from_s(config_.repeat_s);
  for (const chain::Claim& claim : own_) {
    if (claim.module == 0 || config_.claims_muted) continue;
    if (repeat || claim.sequence_number > published_claim_) link_claim_.write(to_message(claim, now));
  }
  published_claim_ = sequence_number_;

  const chain::Announcement& announcement = agreement_.announcement();
  const std::optional<chain::View>& active = agreement_.active();
  const std::uint64_t epoch = active ? active->epoch : 0;
  const bool changed = announcement.sequence_number != published_announcement_ || epoch != published_epoch_ ||
                       active.has_value() != published_active_;
  if (!changed && !repeat) return;
  published_announcement_ = announcement.sequence_number;
  published_epoch_ = epoch;
  published_active_ = active.has_value();
  msg::ChainView out;
  out.module_id = config_.module_id;
  out.stamp_ns = to_ns(now);
  out.incarnation = announcement.incarnation;
  out.sequence_number = announcement.sequence_number;
  out.epoch = announcement.epoch;
  out.phase = static_cast<msg::ViewPhase>(announcement.phase);
  out.start_ns = to_ns(announcement.start);
  out.active = active.has_value();
  static_assert(decltype(out.members)::bound() == decltype(active->members)::bound() &&
                decltype(out.links)::bound() == decltype(active->links)::bound());
  if (active) {
    out.active_epoch = active->epoch;
    out.active_since_ns = to_ns(agreement_.active_since());
    out.base_id = active->base;
    for (const std::uint32_t member : active->members) out.members.push_back(member);
    for (const chain::Link& link : active->links) {
      out.links.push_back({link.module, link.port, link.peer, link.peer_port});
    }
  }
  chain_view_.write(out);
}

std::optional<chain::Link> Membership::link_of(std::uint32_t port) const {
  for (const chain::Link& link : agreement_.graph().links) {
    if (link.module == config_.module_id && link.port == port) return link;
    if (link.peer == config_.module_id && link.peer_port == port) return link.reversed();
  }
  return std::nullopt;
}

bool Membership::linked(std::uint32_t module, std::uint32_t port) const {
  return std::any_of(agreement_.graph().links.begin(), agreement_.graph().links.end(), [&](const chain::Link& link) {
    return (link.module == module && link.port == port) || (link.peer == module && link.peer_port == port);
  });
}

bool Membership::active_with(std::uint32_t other) const {
  return agreement_.active() && agreement_.active()->contains(other) && agreement_.active()->members.size() > 1;
}

}  // namespace eciton::docking
