// The agreement's state machine.
#include "core/chain/agreement.hpp"

#include <algorithm>

namespace eciton::chain {
namespace {

const PeerStatus* find(std::span<const PeerStatus> peers, std::uint32_t module) {
  const auto found =
      std::find_if(peers.begin(), peers.end(), [&](const PeerStatus& peer) { return peer.module == module; });
  return found != peers.end() ? &*found : nullptr;
}

bool speaks_for_all_ports(const ClaimTable& claims, const AgreementConfig& config) {
  for (std::uint32_t port = 0; port < config.ports; ++port) {
    const Claim* const own = claims.find(config.module, port);
    if (own == nullptr || own->incarnation != config.incarnation) return false;
  }
  return true;
}

}  // namespace

void Agreement::update(TimePoint now, const ClaimTable& claims, const AnnouncementTable& announcements,
                       std::span<const PeerStatus> peers) {
  obstacle_ = Obstacle::none;
  obstacle_module_ = 0;
  if (claims_seen_ != claims.revision()) hold_what_follows_from(claims);
  if (!speaks_for_all_ports(claims, config_)) {
    obstacle_ = Obstacle::ports_unknown;
  } else if (refusal_ != Refusal::none) {
    obstacle_ = Obstacle::structure_refused;
  } else if (held_ && (!active_ || active_->epoch != held_->epoch)) {
    if (held_->epoch == 0) {
      activate(now);
    } else {
      learn_start(now, announcements, peers);
      if (start_ == TimePoint{}) {
        if (obstacle_ == Obstacle::none) obstacle_ = Obstacle::no_start;
      } else if (!start_has_come(now, peers)) {
        obstacle_ = Obstacle::waiting;
      } else if (one_is_active(announcements) || all_fresh(peers)) {
        activate(start_);
      }
    }
  }
  announce();
}

void Agreement::hold_what_follows_from(const ClaimTable& claims) {
  claims_seen_ = claims.revision();
  graph_ = build_link_graph(claims);
  if (!speaks_for_all_ports(claims, config_)) return;
  View view;
  refusal_ = view_of(config_.module, claims, graph_, rule_, view);
  if (refusal_ != Refusal::none) {
    held_.reset();
  } else if (!held_ || !(*held_ == view)) {
    held_ = view;
    start_ = {};
  }
}

void Agreement::learn_start(TimePoint now, const AnnouncementTable& announcements,
                            std::span<const PeerStatus> peers) {
  if (start_ != TimePoint{}) return;
  for (const std::uint32_t member : held_->members) {
    const Announcement* const said = announcements.find(member);
    if (said != nullptr && member != config_.module && said->epoch == held_->epoch && said->has_start())
      return adopt_start(now, said->start);
  }
  // Evaluated by every member, so that each can say what it waits for; only the base decides.
  const bool ready = all_announced(announcements) && all_fresh(peers);
  if (ready && held_->base == config_.module) adopt_start(now, now + config_.start_margin);
}

void Agreement::adopt_start(TimePoint now, TimePoint start) {
  start_ = start;
  start_heard_ = now;
}

bool Agreement::start_has_come(TimePoint now, std::span<const PeerStatus> peers) const {
  // The base decided before we heard of it, so there is never more than a margin left to wait: this bounds
  // what a wrong idea of its clock can do.
  const PeerStatus* const base = find(peers, held_->base);
  const Duration offset = base != nullptr ? base->clock_offset.value_or(Duration{}) : Duration{};
  const bool own_clock = held_->base == config_.module;
  return now >= std::min(own_clock ? start_ : start_ - offset, start_heard_ + config_.start_margin);
}

bool Agreement::all_announced(const AnnouncementTable& announcements) {
  for (const std::uint32_t member : held_->members) {
    if (member == config_.module) continue;
    const Announcement* const said = announcements.find(member);
    if (said != nullptr && said->epoch == held_->epoch) continue;
    obstacle_ = Obstacle::member_disagrees;
    obstacle_module_ = member;
    return false;
  }
  return true;
}

bool Agreement::all_fresh(std::span<const PeerStatus> peers) {
  for (const std::uint32_t member : held_->members) {
    if (member == config_.module) continue;
    const PeerStatus* const peer = find(peers, member);
    if (peer != nullptr && peer->fresh) continue;
    obstacle_ = Obstacle::member_silent;
    obstacle_module_ = member;
    return false;
  }
  return true;
}

bool Agreement::one_is_active(const AnnouncementTable& announcements) const {
  return std::any_of(held_->members.begin(), held_->members.end(), [&](std::uint32_t member) {
    const Announcement* const said = announcements.find(member);
    return member != config_.module && said != nullptr && said->epoch == held_->epoch &&
           said->phase == ViewPhase::active;
  });
}

void Agreement::activate(TimePoint since) {
  active_ = held_;
  active_since_ = since;
}

void Agreement::announce() {
  Announcement next = announcement_;
  next.module = config_.module;
  next.incarnation = config_.incarnation;
  if (!held_) {
    // Nothing to hold: the view flown goes on being announced, so that the others see where we stand.
    next.epoch = active_ ? active_->epoch : 0;
    next.phase = active_ ? ViewPhase::active : ViewPhase::none;
    next.start = active_ ? active_since_ : TimePoint{};
  } else {
    const bool is_active = active_ && active_->epoch == held_->epoch;
    next.epoch = held_->epoch;
    next.phase = is_active ? ViewPhase::active : ViewPhase::proposed;
    next.start = is_active ? active_since_ : start_;
  }
  if (announcement_.sequence_number != 0 && next == announcement_) return;
  next.sequence_number = announcement_.sequence_number + 1;
  announcement_ = next;
}

Freshness Agreement::freshness_of(std::uint32_t member, std::span<const PeerStatus> peers) const {
  if (member == config_.module) return Freshness::fresh;
  if (held_ && !held_->contains(member)) return Freshness::left;
  const PeerStatus* const peer = find(peers, member);
  return peer != nullptr && peer->fresh ? Freshness::fresh : Freshness::silent;
}

}  // namespace eciton::chain
