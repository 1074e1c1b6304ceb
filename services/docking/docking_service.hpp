// Docking: goals to the follower's and the target's sequences, their references to control, their latches to
// the hardware, and the chain's membership.
#pragma once

#include <array>
#include <optional>

#include "core/base/config.hpp"
#include "core/bus/participant.hpp"
#include "core/runtime/heartbeat_watch.hpp"
#include "core/runtime/service.hpp"
#include "services/docking/chain_reference.hpp"
#include "services/docking/dock_request.hpp"
#include "services/docking/docking_sequence.hpp"
#include "services/docking/docking_service_heard.hpp"
#include "services/docking/membership_service.hpp"
#include "services/docking/target_sequence.hpp"

namespace eciton::docking {

struct DockingServiceConfig {
  std::uint32_t module_id = 0;
  std::uint64_t incarnation = 1;
  double rate_Hz = 100;
  double start_margin_s = 0.1;   // of a chain view, from its decision to its start: a few crossings of the radio
  double state_rate_Hz = 20;     // of docking_state while docking; it is published on every change besides
  double target_filter_s = 0.2;  // the reference follows the target's pose smoothed by this
  double base_filter_s = 0.5;    // a chain's base is where it is seen from its member, smoothed by this
  double trim_s = 1.5;           // within which a chain's reference is moved by what its port misses
  double push_bias_s = 1.0;      // the push before contact, smoothed by this, counts as none
  bool require_zeroed = true;
  bool claims_muted = false;  // an experiment's control
  bool watches = false;       // the radio, by its heartbeats: where these come by the wall clock
  DockingConfig sequence;
  TargetConfig target;

  template <class V>
  void visit_fields(V& v) {
    v("rate_Hz", rate_Hz, in_range(20, 500));
    v("start_margin_s", start_margin_s, in_range(0.01, 1));
    v("state_rate_Hz", state_rate_Hz, in_range(1, 100));
    v("target_filter_s", target_filter_s, in_range(0, 5));
    v("base_filter_s", base_filter_s, in_range(0, 5));
    v("trim_s", trim_s, in_range(0.5, 100));
    v("push_bias_s", push_bias_s, in_range(0.05, 10));
    v("require_zeroed", require_zeroed);
    v("claims_muted", claims_muted);
    v("standoff_m", sequence.standoff_m, in_range(0.1, 2));
    v("approach_speed_m_s", sequence.approach_speed_m_s, in_range(0.02, 1));
    v("recover_radial_m", sequence.recover_radial_m, in_range(0.01, 0.2));
    v("declare_push_N", sequence.declare_push_N, in_range(0.5, 20));
    v("recoveries_max", sequence.recoveries_max, in_range(0, 100));
    v("retreat_speed_m_s", sequence.retreat_speed_m_s, in_range(0.02, 1));
    v("retreat_gap_m", sequence.retreat_gap_m, in_range(0.1, 2));
  }
};

class DockingService final : public runtime::Service {
 public:
  DockingService(bus::Participant& ring, const DockingServiceConfig& config, const robot::Airframe& airframe);

  std::string_view name() const override { return "docking"; }
  runtime::Schedule schedule() override {
    return runtime::every(from_s(1 / config_.rate_Hz), runtime::Phase::coordinate);
  }
  void step(TimePoint now) noexcept override;
  void describe(msg::Heartbeat& heartbeat) const noexcept override {
    heartbeat.rejected = membership_.claims_refused();
  }
  std::uint32_t state_version() const noexcept override { return 1; }
  /// The goals under way: a start anew knows nothing else of them, and says that they are over.
  void save_state(runtime::StateWriter& writer) const noexcept override {
    writer(goal_pending_ ? goal_id_ : 0, handed_on_.goal_id);
  }
  void load_state(runtime::StateReader& reader) noexcept override { reader(interrupted_[0], interrupted_[1]); }

 private:
  /// What joins the follower's port to the target's.
  struct Pairing {
    std::uint32_t peer = 0;
    std::uint32_t port = 0;
    std::uint32_t peer_port = 0;
  };
  /// A docking that was asked of us and that the member at the end of our chain does: see docs/decisions/0010.
  struct HandedOn {
    std::uint64_t goal_id = 0;  // 0: none
    std::uint32_t member = 0;
    Pairing pairing;  // the member's
    TimePoint since{};
    bool begun = false;
  };

  // docking_service_goals.cpp
  void take_goals(TimePoint now) noexcept;
  void end_interrupted(TimePoint now) noexcept;
  void dock(const msg::DockGoal& goal, TimePoint now) noexcept;
  void undock(const msg::DockGoal& goal, TimePoint now) noexcept;
  void begin_docking(const PortChoice& choice, std::uint64_t goal_id, TimePoint now) noexcept;
  void take_handed_on(TimePoint now) noexcept;
  void watch_handed_on(TimePoint now) noexcept;
  DockAnswer judge(std::uint32_t target_id, const std::optional<PortChoice>& choice, TimePoint now) const;
  void add_side(std::uint32_t named, BoundedVector<Candidate, chain::max_modules>& side, TimePoint now) const;
  Candidate candidate(std::uint32_t id, TimePoint now) const;
  void add_free_ports(std::uint32_t module_id, TimePoint now,
                      BoundedVector<FreePort, 2 * robot::members_max>& ports) const;
  void answer(std::uint64_t correlation_id, msg::GoalPhase phase, std::string_view reason, TimePoint now) noexcept;

  const chain::View* chain() const;  // the active view, when it has other members
  bool is_member(std::uint32_t id) const { return chain() != nullptr && chain()->contains(id); }
  bool under_way() const { return following_ || (is_target_ && target_.outputs().phase != DockingPhase::docked); }
  bool near() const { return under_way() || chain() != nullptr; }
  bool is_fresh(const HeardModule& module, TimePoint now) const { return heard_.is_fresh(module, near(), now); }

  void follow(TimePoint now, double dt_s) noexcept;
  void trim(const robot::Pose& X_WF, double dt_s) noexcept;
  void measure_push(const robot::Matrix3& R_WT, double dt_s) noexcept;
  void be_target(TimePoint now, double dt_s) noexcept;
  void accept_follower(TimePoint now) noexcept;
  void watch_radio(TimePoint now) noexcept;
  void update_membership(TimePoint now) noexcept;
  void update_base(TimePoint now, double dt_s) noexcept;
  void write_reference(TimePoint now) noexcept;
  void tell_latch(std::uint32_t port, bool engage, TimePoint now) noexcept;
  msg::DockingState state_message() const noexcept;
  void write_state(TimePoint now) noexcept;

  DockingServiceConfig config_;
  robot::Airframe airframe_;
  bus::Participant& ring_;
  Membership membership_;
  DockingSequence follower_;
  TargetSequence target_;
  HeardModules heard_;
  runtime::HeartbeatWatch radio_watch_;

  Pairing pairing_;                                 // of the docking we follow or are the target of, or were last
  msg::DockingRole role_ = msg::DockingRole::none;  // in it
  bool following_ = false;
  bool is_target_ = false;  // docked to, too
  std::uint64_t goal_id_ = 0;
  std::uint64_t answered_ = 0;
  std::uint64_t taken_over_ = 0;  // the last docking that a chain mate handed on to us
  bool goal_pending_ = false;
  HandedOn handed_on_;
  std::array<std::uint64_t, 2> interrupted_{};             // goals that the last start left unanswered
  SmoothedPose X_WT_;                                      // the target's port
  SmoothedPose X_MB_;                                      // our chain's base, from our own M
  std::uint64_t base_epoch_ = 0;                           // of the chain it belongs to
  robot::Vector3 trim_W_ = robot::Vector3::Zero();         // of our chain's reference, by what misses at the standoff
  robot::Vector3 chain_force_W_ = robot::Vector3::Zero();  // on all of our chain
  TimePoint chain_force_at_{};
  double push_bias_N_ = 0;
  double push_N_ = 0;
  std::array<std::optional<bool>, chain::max_ports> latch_told_{};
  std::array<TimePoint, chain::max_ports> latch_told_at_{};
  msg::DockingState state_;
  TimePoint state_due_{};
  TimePoint last_step_{};
  bool first_step_ = true;

  bus::Reader<msg::DockGoal> dock_goal_;
  bus::Reader<msg::ContactWrench> contact_wrench_;
  bus::Writer<msg::DockingReference> docking_reference_;
  bus::Writer<msg::LatchCommand> latch_command_;
  bus::Writer<msg::DockingState> docking_state_;
  bus::Writer<msg::GoalStatus> goal_status_;
  bus::Writer<msg::Event> event_;
  bus::Writer<msg::Fault> fault_;
};

}  // namespace eciton::docking
