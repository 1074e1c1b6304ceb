// The feed-forward wrench by which a member of a chain brings the contact wrenches to what is wanted. Two
// laws, side by side: the paper's, (11) to (13), solved outward from the base and applied incrementally;
// and a local one, ff_i <- ff_i + gamma (d_i - dbar_i), in which no module is special. World axes throughout.
#pragma once

#include <cstddef>
#include <span>

#include "core/robot/airframe.hpp"
#include "core/robot/freshness.hpp"

namespace eciton::control {

enum class ContactLaw { none, paper, local };

struct ContactWrenchLawConfig {
  ContactLaw law = ContactLaw::local;
  double observer_gain_1_s = 10;  // K_I of the wrench observer: the local law's rate is at most a third
  double bending_rate_1_s = 14;   // and this by the number of members: above it the chain's bending is excited
  double paper_period_s = 0.1;    // the paper's law limit-cycles from N = 3 when applied at 100 Hz
  double paper_gain = 0.4;        // gamma for N = 2, halved for each further member
  double sign = 1;                // -1: against all sense, for an experiment that must fail
  double force_N_max = 15;        // of the feed-forward, per axis
  double moment_Nm_max = 3;
  double fade_time_constant_s = 5.0;  // of the feed-forward, when all peers are gone
  robot::FreshnessConfig freshness{};
};

/// A member as the contact wrench estimate shows it, in the order of the chain.
struct ChainMember {
  robot::Wrench d_W;        // external less common wrench, about r
  robot::Wrench contact_W;  // of this member on the next, about P
  robot::Vector3 r_W = robot::Vector3::Zero();
  robot::Vector3 link_W = robot::Vector3::Zero();  // P, to the next member
  double age_s = 0;
};

/// Index of the base: number (n + 1) / 2, counted from 1.
constexpr std::size_t base_index(std::size_t members) { return members > 0 ? (members + 1) / 2 - 1 : 0; }

/// Keeps its own feed-forward wrench. A member that grows silent counts less and less (the estimate fades
/// its d); the own feed-forward fades with the share of peers that are gone. Real-time safe; one thread.
class ContactWrenchLaw {
 public:
  explicit ContactWrenchLaw(const ContactWrenchLawConfig& config = {}) : config_(config) {}

  /// `desired_W`: wanted contact wrench of each member on the next about P, or empty for none.
  /// `dt_s` since the last update. Returns the feed-forward about the own composite centre of mass.
  const robot::Wrench& update(std::span<const ChainMember> members, std::size_t own,
                              std::span<const robot::Wrench> desired_W, double dt_s);
  /// No estimate came: only the fading goes on.
  const robot::Wrench& fade(double dt_s);
  /// The module has turned: what strains it are mostly joints that stand a little beside their angles, and turn with
  /// it. `turn_W`: from the axes of before to those of now.
  void turn(const robot::Matrix3& turn_W) { feed_forward_W_ = robot::rotate(turn_W, feed_forward_W_); }
  void set_law(ContactLaw law) { config_.law = law; }
  void reset();
  void set_feed_forward(const robot::Wrench& feed_forward_W) { feed_forward_W_ = feed_forward_W; }

  const robot::Wrench& feed_forward_W() const { return feed_forward_W_; }
  bool clamped() const { return clamped_; }

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.feed_forward_W_, self.paper_wait_s_, self.clamped_);
  }

 private:
  void add(const robot::Wrench& step);

  ContactWrenchLawConfig config_;
  robot::Wrench feed_forward_W_;
  double paper_wait_s_ = 0;
  bool clamped_ = false;
};

/// Step of the local law, gamma left out: d - dbar of member `own`.
robot::Wrench local_step(std::span<const ChainMember> members, std::size_t own,
                         std::span<const robot::Wrench> desired_W);
/// Step of the paper's law, gamma left out: from delta_i = cbar_i - c_i = X(r_i - P_i) s_i -
/// X(r_{i+1} - P_i) s_{i+1} with s_base = 0.
robot::Wrench paper_step(std::span<const ChainMember> members, std::size_t own,
                         std::span<const robot::Wrench> desired_W);

}  // namespace eciton::control
