// How the members of a structure come to fly one view, without a master. Per module; pure logic.
//
// Every module announces the view that follows from the claims it has heard. When the view's base has heard
// every member, all fresh, announce the base's own epoch, it decides the start: its time plus a margin. It
// does so once for an epoch. Epochs are never used twice and name the incarnation of each member, the base's
// too, so an epoch has one start, ever. Members adopt it from the base or from whoever passes it on, as it
// stands, on the base's clock. A member makes the view active when the start has come and it either finds
// all members fresh or hears of one that has made it active already: so a view does not become active while
// a member is silent, and does not stay active at one member alone. Who hears of the start late switches
// late, at once. Until then the view before stays active. A single module needs nobody: epoch 0, at once.
#pragma once

#include <optional>
#include <span>

#include "core/chain/announcement.hpp"
#include "core/chain/freshness.hpp"

namespace eciton::chain {

struct AgreementConfig {
  std::uint32_t module = 0;
  std::uint64_t incarnation = 0;
  std::uint32_t ports = 2;        // of this airframe
  Duration start_margin = 100ms;  // from decision to start: a few crossings of the radio, with one loss
};

/// What the caller knows about another module, from its beacons and samples.
struct PeerStatus {
  std::uint32_t module = 0;
  bool fresh = false;
  std::optional<Duration> clock_offset;  // its clock less ours; nothing: not known yet, taken as zero
};

/// Why the view held is not active.
enum class Obstacle : std::uint8_t {
  none,
  ports_unknown,      // this module has not claimed or withdrawn each of its ports since it started
  structure_refused,  // see Agreement::refusal
  member_silent,
  member_disagrees,  // it has not announced our epoch
  no_start,          // the base has not decided yet
  waiting            // for the start
};

class Agreement {
 public:
  /// `rule` must outlive this.
  Agreement(const AgreementConfig& config, const StructureRule& rule) : config_(config), rule_(rule) {}

  /// Once a period; `claims` is always the same table. Modules missing among `peers` are not fresh.
  /// Real-time safe: no allocation, O(claims) and only when they changed.
  void update(TimePoint now, const ClaimTable& claims, const AnnouncementTable& announcements,
              std::span<const PeerStatus> peers);

  /// To be published whenever its sequence number changed, and it may be repeated at will.
  const Announcement& announcement() const { return announcement_; }
  /// The view that follows from the claims; nothing before all own ports are known.
  const std::optional<View>& held() const { return held_; }
  /// The view to fly by; nothing after a restart until there is an agreement.
  const std::optional<View>& active() const { return active_; }
  /// When `active` began, on its base's clock; a single module's: on its own.
  TimePoint active_since() const { return active_since_; }

  Obstacle obstacle() const { return obstacle_; }
  std::uint32_t obstacle_module() const { return obstacle_module_; }  // silent or disagreeing
  Refusal refusal() const { return refusal_; }
  const LinkGraph& graph() const { return graph_; }
  /// Of a member of the active view.
  Freshness freshness_of(std::uint32_t member, std::span<const PeerStatus> peers) const;

 private:
  void hold_what_follows_from(const ClaimTable& claims);
  void learn_start(TimePoint now, const AnnouncementTable& announcements, std::span<const PeerStatus> peers);
  void adopt_start(TimePoint now, TimePoint start);
  bool start_has_come(TimePoint now, std::span<const PeerStatus> peers) const;
  bool all_announced(const AnnouncementTable& announcements);
  bool all_fresh(std::span<const PeerStatus> peers);
  bool one_is_active(const AnnouncementTable& announcements) const;
  void activate(TimePoint since);
  void announce();

  AgreementConfig config_;
  const StructureRule& rule_;

  std::optional<std::uint64_t> claims_seen_;  // revision
  LinkGraph graph_;
  Refusal refusal_ = Refusal::none;
  std::optional<View> held_;
  std::optional<View> active_;
  TimePoint active_since_{};
  TimePoint start_{};        // of the view held, on its base's clock; zero: not known
  TimePoint start_heard_{};  // on our clock
  Obstacle obstacle_ = Obstacle::ports_unknown;
  std::uint32_t obstacle_module_ = 0;
  Announcement announcement_;
};

}  // namespace eciton::chain
