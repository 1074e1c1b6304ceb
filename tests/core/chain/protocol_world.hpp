// A small faulty world for the chain protocol: modules that dock, undock, crash and restart as a schedule says, and a
// radio that loses, delays, reorders and duplicates. It knows the truth and watches for what must never happen.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "core/chain/agreement.hpp"
#include "tests/core/chain/lattice_rule.hpp"
#include "tests/core/chain/schedule.hpp"

namespace eciton::chain::test {

/// Deliberate faults of the modules, each of which the world has to notice.
enum class Mutation {
  none,
  last_arrival_wins,  // claims are overwritten instead of joined
  silence_unlinks,    // claims of silent modules are dropped
  never_silent,       // everyone ever heard counts as fresh
  restart_forgets,    // a restarted module comes back as the incarnation it was
  takes_for_granted   // a module believes that all others announced what it holds
};

struct WorldConfig {
  Mutation mutation = Mutation::none;
  Duration agreement_bound = 2s;  // after anything that disturbs it, a healed partition too, at 60 % loss
};

struct WorldResult {
  std::optional<std::string> violation;
  int docked = 0, undocked = 0, crashed = 0, partitions = 0;
  int refused = 0, false_claims = 0;
  int chains_activated = 0;    // by anyone, for the first time
  int largest = 0;             // members of one view
  Duration convergence_max{};  // the longest that linked modules took, undisturbed, to fly what is linked
  std::uint64_t digest = 0;    // of every activation: equal for equal runs
};

class World {
 public:
  World(const Schedule& schedule, const WorldConfig& config);
  WorldResult run();

 private:
  static constexpr Duration tick = 10ms;
  static constexpr Duration broadcast_period = 20ms;
  static constexpr int delay_ticks_max = 30;

  struct Port {
    int peer = -1, peer_port = -1;                      // physically; -1: free
    Duration changed{};                                 // when
    Duration latch_delay{};                             // until the latch reports it
    std::uint32_t known_peer = 0, known_peer_port = 0;  // what the module's checkpoint says
    bool checkpoint_lost = false;
    Duration false_until{};  // until then its latch claims what is not so
    int false_peer = 0, false_peer_port = 0;
  };
  struct Module {
    std::uint32_t id = 0;
    bool live = true;
    int group = 0;  // of the partition
    Duration clock{}, started{}, disturbed{}, activated{};
    Duration muted_until{};  // its claims are heard, its announcements are not
    std::uint64_t incarnation = 0, claims_made = 0;
    std::array<Port, max_ports> port;
    ClaimTable claims;
    AnnouncementTable announcements;
    std::vector<Duration> heard;
    std::vector<Duration> could_hear;  // when that module was last live and on our side of the partition
    std::vector<std::optional<Duration>> offset_error;
    BoundedVector<PeerStatus, max_modules> peers;
    std::optional<Agreement> agreement;
    std::optional<View> flown;            // the active view at the last look
    std::set<std::uint64_t> once_active;  // epochs, in this incarnation
  };
  struct Message {
    int from, to;
    std::size_t said;  // among `said_`
  };
  using Saying = std::variant<Claim, Announcement>;

  /// Chance, the same for the same question: no event left out changes the answer to another.
  std::uint64_t chance(std::uint64_t a, std::uint64_t b, std::uint64_t c) const;

  void start(Module& module);
  void apply(const Event& event);
  void dock(const Event& event);
  void undock(const Event& event);
  void crash(Module& module);
  void restart(Module& module, bool checkpoint_lost);
  void claim_falsely(const Event& event);
  void stop_faults();
  bool fits_the_grid(int a, int a_port, int b) const;
  bool anyone_unsure() const;  // whose port lost its checkpoint

  void deliver();
  void receive(Module& module, const Message& message);
  void claim_what_latches_report(Module& module);
  std::optional<Claim> claim_for(const Module& module, int port) const;
  void step(Module& module);
  void broadcast(int from);
  void look_at_peers(Module& module);
  AnnouncementTable announcements_taken_for_granted(const Module& module) const;
  ClaimTable claims_without_silent(const Module& module) const;

  const std::vector<int>& component_of(int module) const { return components_[component_at_[module]]; }
  void find_components();
  bool refused(const std::vector<int>& component) const;  // by the airframe: a ring
  void note_disturbances();
  void watch(Module& module);
  void watch_new_view(Module& module, const View& view);
  void watch_lost_links(const Module& module, const View& before, const View& after);
  void watch_convergence();
  bool converged(const std::vector<int>& component);
  void violate(const std::string& what);

  Schedule schedule_;
  WorldConfig config_;
  std::size_t next_event_ = 0;
  int ports_;
  Duration now_{};
  std::vector<Module> modules_;
  std::array<std::vector<Message>, delay_ticks_max + 1> in_flight_;
  std::size_t slot_ = 0;
  std::vector<Saying> said_;
  ChainRule chain_rule_;
  LatticeRule lattice_rule_;
  const StructureRule& rule_;
  WorldResult result_;
  std::vector<std::vector<int>> components_;
  std::vector<std::size_t> component_at_;
  std::set<Link> ever_linked_;  // both ways round

  std::map<std::uint64_t, std::set<std::uint32_t>> announced_by_;  // epoch -> who ever held it
  std::map<std::uint64_t, View> view_of_;                          // epoch -> the one view it stands for
  std::map<std::uint64_t, TimePoint> start_of_;
};

}  // namespace eciton::chain::test
