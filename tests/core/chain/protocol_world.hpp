// A small faulty world for the chain protocol: modules that dock, undock, crash and restart, and a radio that
// loses, delays, reorders and duplicates. It knows the truth and watches for what must never happen.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "core/chain/agreement.hpp"

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
  std::uint64_t seed = 1;
  Mutation mutation = Mutation::none;
  Duration faulty_for = 20s;
  Duration agreement_bound = 3500ms;  // at 60 % loss: three times 45 rounds of 20 ms, the margin, the delays
};

struct WorldResult {
  std::optional<std::string> violation;
  int docked = 0, undocked = 0, crashed = 0, partitions = 0;
  int chains_activated = 0;  // by anyone, for the first time
};

class World {
 public:
  explicit World(const WorldConfig& config);
  WorldResult run();

 private:
  static constexpr Duration tick = 10ms;
  static constexpr Duration broadcast_period = 20ms;
  static constexpr int delay_ticks_max = 30;
  static constexpr int ports = 2;

  struct Port {
    int peer = -1, peer_port = -1;                      // physically; -1: free
    Duration changed{};                                 // when
    Duration latch_delay{};                             // until the latch reports it
    std::uint32_t known_peer = 0, known_peer_port = 0;  // what the module's checkpoint says
    bool checkpoint_lost = false;
  };
  struct Module {
    std::uint32_t id = 0;
    bool live = true;
    int group = 0;  // of the partition
    Duration clock{}, started{}, disturbed{}, activated{};
    Duration muted_until{};  // its claims are heard, its announcements are not
    std::uint64_t incarnation = 0, claims_made = 0;
    std::array<Port, ports> port;
    ClaimTable claims;
    AnnouncementTable announcements;
    std::vector<Duration> heard;
    std::vector<Duration> could_hear;  // when that module was last live and on our side of the partition
    std::vector<std::optional<Duration>> offset_error;
    std::optional<Agreement> agreement;
    std::optional<View> flown;            // the active view at the last look
    std::set<std::uint64_t> once_active;  // epochs, in this incarnation
  };
  struct Message {
    int from, to;
    std::optional<Claim> claim;
    std::optional<Announcement> announcement;
  };

  double random() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  int random(int n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }
  bool happens_per_s(double rate) { return random() < rate * to_s(tick); }

  void start(Module& module);
  void cause_faults();
  void try_dock();
  void undock();
  void crash_or_restart();
  void split_or_heal();
  void stop_faults();

  void deliver();
  void receive(Module& module, const Message& message);
  void claim_what_latches_report(Module& module);
  std::optional<Claim> claim_for(const Module& module, int port) const;
  void step(Module& module);
  void broadcast(int from);
  std::vector<PeerStatus> peers_of(const Module& module) const;
  AnnouncementTable announcements_taken_for_granted(const Module& module) const;
  ClaimTable claims_without_silent(const Module& module, const std::vector<PeerStatus>& peers) const;

  std::vector<int> component_of(int module) const;
  void note_disturbances();
  void watch(Module& module);
  void watch_new_view(Module& module, const View& view);
  void watch_lost_links(const Module& module, const View& before, const View& after);
  void watch_convergence();
  void violate(const std::string& what);

  WorldConfig config_;
  std::mt19937_64 random_;
  double loss_ = 0;
  double pace_ = 1;  // of faults and dockings
  bool clocks_known_ = true;
  Duration now_{};
  std::vector<Module> modules_;
  std::array<std::vector<Message>, delay_ticks_max + 1> in_flight_;
  std::size_t slot_ = 0;
  ChainRule rule_;
  WorldResult result_;

  std::map<std::uint64_t, std::set<std::uint32_t>> announced_by_;  // epoch -> who ever held it
  std::map<std::uint64_t, View> view_of_;                          // epoch -> the one view it stands for
  std::map<std::uint64_t, TimePoint> start_of_;
};

}  // namespace eciton::chain::test
