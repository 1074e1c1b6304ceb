// The docking service's half that keeps the chain: latch evidence becomes link claims, everyone's claims the
// link graph, and the members' announcements an agreed view. Messages on one side, core/chain on the other.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/bus/participant.hpp"
#include "core/chain/agreement.hpp"
#include "idl/topics.hpp"

namespace eciton::docking {

struct MembershipConfig {
  std::uint32_t module_id = 0;
  std::uint64_t incarnation = 1;
  std::uint32_t ports = 2;
  bool claims_muted = false;    // an experiment's control: claims are made but never published
  double start_margin_s = 0.1;  // of a view, from decision to start
  double listen_s = 0.5;        // after a start, before somebody's claim is believed to name our port's peer
  double repeat_s = 1.0;        // what is announced is said again so often: a late listener needs no history
};

class Membership {
 public:
  Membership(bus::Participant& ring, const MembershipConfig& config);

  /// Whom a port is about to link with, as the docking knows it.
  void expect(std::uint32_t port, std::uint32_t peer, std::uint32_t peer_port);
  /// Takes what came, agrees, announces. Real-time safe.
  void update(TimePoint now, std::span<const chain::PeerStatus> peers) noexcept;

  chain::LatchStatus latch(std::uint32_t port) const { return latches_[port].status; }
  const chain::Agreement& agreement() const { return agreement_; }
  const chain::ClaimTable& claims() const { return claims_; }
  /// The link of one of our ports, as the claims have it.
  std::optional<chain::Link> link_of(std::uint32_t port) const;
  bool linked(std::uint32_t module, std::uint32_t port) const;
  /// Whether the active view holds both us and `other`.
  bool active_with(std::uint32_t other) const;
  /// Claims that were not taken: the radio lets in none of them, so somebody else on the ring made them.
  std::uint64_t claims_refused() const { return claims_refused_ + claims_.refused(); }

 private:
  struct Latch {
    bool known = false;
    chain::LatchStatus status = chain::LatchStatus::open;
    std::uint32_t peer = 0;
    std::uint32_t peer_port = 0;
  };

  void take(TimePoint now) noexcept;
  bool possible(const chain::Claim& claim) const noexcept;
  void claim(std::uint32_t port, TimePoint now) noexcept;
  void publish(TimePoint now) noexcept;

  MembershipConfig config_;
  chain::ChainRule rule_;
  chain::Agreement agreement_;
  chain::ClaimTable claims_;
  chain::AnnouncementTable announcements_;
  std::array<Latch, chain::max_ports> latches_{};
  std::array<chain::Claim, chain::max_ports> own_{};
  std::uint64_t claims_refused_ = 0;
  std::uint64_t sequence_number_ = 0;
  std::uint64_t published_claim_ = 0;
  std::uint64_t published_announcement_ = 0;
  std::uint64_t published_epoch_ = 0;
  bool published_active_ = false;
  TimePoint repeat_due_{};
  std::optional<TimePoint> started_;

  bus::Reader<msg::LatchState> latch_state_;
  bus::Reader<msg::LinkClaim> link_claims_;
  bus::Reader<msg::ChainView> chain_views_;
  bus::Writer<msg::LinkClaim> link_claim_;
  bus::Writer<msg::ChainView> chain_view_;
};

}  // namespace eciton::docking
