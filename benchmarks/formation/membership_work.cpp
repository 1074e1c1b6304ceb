// As services/docking/docking_service.cpp does it, less goals, references and latches.
#include "benchmarks/formation/membership_work.hpp"

#include <algorithm>

namespace eciton::bench {

MembershipWork::MembershipWork(bus::Participant& ring, const docking::DockingServiceConfig& config,
                               std::uint32_t ports)
    : config_(config),
      ring_(ring),
      membership_(ring, {.module_id = config.module_id,
                         .incarnation = config.incarnation,
                         .ports = ports,
                         .start_margin_s = config.start_margin_s}),
      module_states_(ring.create_reader(topics::module_state)),
      external_wrenches_(ring.create_reader(topics::external_wrench)),
      docking_states_(ring.create_reader(topics::docking_state)),
      beacons_(ring.create_reader(topics::beacon)),
      docking_state_(ring.create_writer(topics::docking_state)) {}

void MembershipWork::order(const MemberOrder& order) {
  const std::lock_guard lock(orders_mutex_);
  pending_ = order;
}

void MembershipWork::step(TimePoint now) noexcept {
  follow_orders();
  take(now);
  update_membership(now);
  write_state(now);
  first_step_ = false;
}

void MembershipWork::follow_orders() noexcept {
  const std::unique_lock lock(orders_mutex_, std::try_to_lock);
  if (!lock || !pending_) return;
  if (pending_->what == MemberOrder::What::approach) {
    docking_ = pending_;
    membership_.expect(docking_->port, docking_->peer, docking_->peer_port);
  } else if (pending_->what == MemberOrder::What::release) {
    docking_.reset();
  }
  pending_.reset();
}

MembershipWork::Peer* MembershipWork::find(std::uint32_t id) noexcept {
  for (Peer& peer : peers_) {
    if (peer.id == id) return &peer;
    if (peer.id != 0) continue;
    peer.id = id;
    return &peer;
  }
  return nullptr;
}

void MembershipWork::hear(std::uint32_t id, TimePoint at) noexcept {
  Peer* peer = id != config_.module_id ? find(id) : nullptr;
  if (peer != nullptr) peer->heard = std::max(peer->heard, at);
}

void MembershipWork::take(TimePoint now) noexcept {
  while (const auto s = module_states_.take()) hear(s->value.module_id, now - s->age);
  while (const auto s = external_wrenches_.take()) hear(s->value.module_id, now - s->age);
  while (const auto s = docking_states_.take()) hear(s->value.module_id, now - s->age);
  while (const auto s = beacons_.take()) hear(s->value.module_id, now);
}

bool MembershipWork::near() const {
  return docking_ || (membership_.agreement().active() && membership_.agreement().active()->epoch != 0);
}

void MembershipWork::update_membership(TimePoint now) noexcept {
  constexpr chain::FreshnessConfig freshness;
  BoundedVector<chain::PeerStatus, std::tuple_size_v<decltype(peers_)>> peers;
  for (const Peer& peer : peers_) {
    if (peer.id == 0) continue;
    const bool fresh = peer.heard != TimePoint{} && chain::is_fresh(now - peer.heard, near(), freshness);
    peers.push_back({.module = peer.id, .fresh = fresh, .clock_offset = ring_.clock_offset(peer.id)});
  }
  membership_.update(now, {peers.data(), peers.size()});
}

/// What makes the radios send wrenches: from the approach until the link is part of the active view.
void MembershipWork::write_state(TimePoint now) noexcept {
  msg::DockingState out;
  out.module_id = config_.module_id;
  if (docking_) {
    const bool docked = membership_.active_with(docking_->peer);
    out.phase = docked ? msg::DockingPhase::docked : msg::DockingPhase::assembly;
    out.role = docking_->follower != 0 ? msg::DockingRole::follower : msg::DockingRole::target;
    out.port = docking_->port;
    out.peer_id = docking_->peer;
    out.peer_port = docking_->peer_port;
  }
  const bool changed = out.phase != state_.phase || out.peer_id != state_.peer_id;
  if (!changed && !(docking_ && now >= state_due_) && !first_step_) return;
  state_due_ = now + from_s(1 / config_.state_rate_Hz);
  out.stamp_ns = to_ns(now);
  state_ = out;
  docking_state_.write(out);
}

}  // namespace eciton::bench
