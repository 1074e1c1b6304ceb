// From the module's state and its goals to rotor commands: flight modes, references, pose control with the
// contact-wrench feed-forward, allocation.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/base/config.hpp"
#include "core/bus/participant.hpp"
#include "core/robot/allocation.hpp"
#include "core/robot/kinematics.hpp"
#include "core/robot/model_errors.hpp"
#include "core/runtime/fault_reporter.hpp"
#include "core/runtime/service.hpp"
#include "idl/topics.hpp"
#include "services/control/contact_wrench_law.hpp"
#include "services/control/control_service_neighbourhood.hpp"
#include "services/control/disturbance_feedback.hpp"
#include "services/control/flight_mode.hpp"
#include "services/control/flight_reference.hpp"
#include "services/control/goal_checks.hpp"
#include "services/control/hand_over.hpp"
#include "services/control/pose_control.hpp"
#include "services/control/separation.hpp"

namespace eciton::control {

struct ControlConfig {
  std::uint32_t module_id = 0;
  double period_s = 0.002;  // its own pace, where states come slower
  std::string law = "local";
  double paper_gain = 0.4;     // of the paper's law: gamma at N = 2, halved for each further member
  double paper_rate_Hz = 10;   // and how often it is applied
  double local_rate_1_s = 14;  // of the local law, by the number of members; at most a third of the observer's gain
  bool integrate_all = false;  // in a chain every member's pose integral runs, as in the paper; else the base's alone
  double stiffness = 0;        // of the pose control in a chain: 0 gentle, 1 as stiff as in free flight
  double stiffness_alone = 1;  // and when it flies alone or docks
  double law_sign = 1;         // -1: an experiment's control, which must fail
  bool disturbance_feedback = true;  // the observer's wrench fed back in free flight
  bool model_correction = true;      // what zeroing found to be false in the airframe's model is made up for
  double takeoff_m_s = 0.5;
  double landing_m_s = 0.3;
  double speed_m_s = 0.5;
  bool separation = true;                          // keeps its distance from modules it does not dock with
  std::array<double, 3> fence_low_m{-50, -50, 0};  // of the box, in W, that centres of mass stay in
  std::array<double, 3> fence_high_m{50, 50, 30};
  double height_m_min = 0.3;           // of goals
  double observer_gain_1_s = 10;       // as estimation's config says: the law's rate follows from it
  runtime::RecorderConfig recorder{};  // as the module's config says

  template <class V>
  void visit_fields(V& v) {
    v("period_s", period_s, in_range(0.001, 0.02));
    v("law", law, one_of({"none", "paper", "local"}));
    v("paper_gain", paper_gain, in_range(0.001, 1));
    v("paper_rate_Hz", paper_rate_Hz, in_range(1, 100));
    v("local_rate_1_s", local_rate_1_s, in_range(0.1, 100));
    v("integrate_all", integrate_all);
    v("stiffness", stiffness, in_range(0, 1));
    v("stiffness_alone", stiffness_alone, in_range(0, 1));
    v("disturbance_feedback", disturbance_feedback);
    v("model_correction", model_correction);
    v("takeoff_m_s", takeoff_m_s, in_range(0.05, 2));
    v("landing_m_s", landing_m_s, in_range(0.05, 1));
    v("speed_m_s", speed_m_s, in_range(0.05, 2));
    v("separation", separation);
    v("fence_low_m", fence_low_m);
    v("fence_high_m", fence_high_m);
    v("height_m_min", height_m_min, in_range(-100, 100));
  }
};

class ControlService final : public runtime::Service {
 public:
  ControlService(bus::Participant& ring, const ControlConfig& config, const robot::Airframe& airframe);

  std::string_view name() const override { return "control"; }
  runtime::Schedule schedule() override {
    return runtime::on(module_state_, from_s(config_.period_s), runtime::Phase::control);
  }
  void step(TimePoint now) noexcept override;
  std::uint32_t state_version() const noexcept override { return 5; }
  void save_state(runtime::StateWriter& writer) const noexcept override { visit_state(*this, writer); }
  void load_state(runtime::StateReader& reader) noexcept override;
  void describe(msg::Heartbeat& heartbeat) const noexcept override {
    heartbeat.flight_mode = to_message(mode_);
    heartbeat.rejected = rejected_;
  }

 private:
  static msg::FlightMode to_message(FlightMode mode) { return static_cast<msg::FlightMode>(mode); }
  double seconds(TimePoint t) const { return to_s(t - epoch_); }
  std::span<const double> joint_angles() const { return std::span(joint_rad_).first(airframe_.joints.size()); }

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.mode_, self.reference_, self.separation_, self.flown_, self.pose_control_, self.law_, self.feedback_,
      self.allocator_, self.epoch_, self.last_step_, self.view_, self.goal_id_, self.goal_is_ours_,
      self.goal_pending_, self.contact_goal_now_, self.answered_mode_, self.answered_flight_, self.answered_morph_,
      self.answered_contact_, self.errors_, self.base_);
  }

  /// After a start: whether it is known what the rotors do and what follows from it.
  bool settled(TimePoint now) noexcept;
  void take_state(TimePoint now) noexcept;
  void take_surroundings(TimePoint now) noexcept;
  void take_chain(TimePoint now) noexcept;
  void take_requests(TimePoint now) noexcept;
  void take_wrenches(TimePoint now) noexcept;
  void take_base_reference(TimePoint now) noexcept;
  void follow_integrals(const robot::Vector3& linear_W_m_s2, const robot::Vector3& angular_W_rad_s2,
                        double now_s) noexcept;

  void take_goals(TimePoint now) noexcept;
  void take_flight_goal(const msg::FlightGoal& goal, TimePoint now) noexcept;
  void take_path_goal(const msg::PathGoal& goal, TimePoint now) noexcept;
  void take_morph_goal(const msg::MorphGoal& goal, TimePoint now) noexcept;
  void take_contact_goal(const msg::ContactGoal& goal, TimePoint now) noexcept;
  void take_docking_reference(const msg::DockingReference& reference, TimePoint at, TimePoint now) noexcept;
  bool concerns_us(std::uint32_t module_id) const;
  double start_s(std::int64_t start_ns, TimePoint now) const;
  FlightDecision decide_goal(const msg::FlightGoal& goal, TimePoint now) noexcept;
  GoalLimits goal_limits() const;
  FlightDecision refuse(const GoalFault& fault) noexcept;
  /// Of goto and path: the fields, ...
  std::optional<GoalFault> check_fields(const msg::FlightGoal& goal, TimePoint now) const noexcept;
  std::optional<GoalFault> check_fields(const msg::PathGoal& goal, TimePoint now) const noexcept;
  /// ... and the way they lead, of every member.
  template <class Way>
  std::optional<GoalFault> check_way(const Way& way) noexcept;
  FlightDecision decide_motion() const noexcept;
  void answer_flight(std::uint32_t module_id, std::uint64_t correlation_id, const FlightDecision& decision,
                     TimePoint now) noexcept;
  void begin(const msg::FlightGoal& goal, TimePoint now) noexcept;

  void enter_chain(const msg::ChainView& view, TimePoint now) noexcept;
  void see_base(TimePoint now) noexcept;
  /// Contact wrenches asked for, each turned into world axes by its member's reference.
  std::span<const robot::Wrench> desired_contacts(std::span<robot::Wrench> room, TimePoint now) const noexcept;
  /// The reference to fly: it gives way to others, unless this module is part of a chain.
  robot::PoseReference separated(TimePoint now, double dt_s) noexcept;
  void judge(TimePoint now) noexcept;
  void follow_mode(TimePoint now) noexcept;
  void write_rotors(TimePoint now) noexcept;
  void write_base_reference(TimePoint now) noexcept;
  void write_idle(TimePoint now) noexcept;
  robot::Wrench feed_forward(double dt_s) noexcept;

  /// The docking this module flies in: its own, or its chain's at another member.
  const msg::DockingState& docking_now() const;
  static bool is_docking(const msg::DockingState& state);
  bool in_chain() const { return reference_.in_chain(); }
  bool is_base() const { return in_chain() && view_.base_id == config_.module_id; }
  /// In a chain the base holds the place, and whoever sees it a little elsewhere gives way: integrals that disagree
  /// would pull against each other for ever. The others fly what the base's integrals become.
  bool integrates() const { return config_.integrate_all || !in_chain() || is_base(); }
  bool is_member(std::uint32_t module_id) const;
  void answer(msg::GoalKind kind, std::uint64_t correlation_id, msg::GoalPhase phase, std::string_view reason,
              TimePoint now) noexcept;
  void report_mode(TimePoint now) noexcept;
  // control_service_record.cpp
  static std::vector<runtime::Column> recorded(const robot::Airframe& airframe);
  /// What this step knew and did.
  void record(TimePoint now) noexcept;

  ControlConfig config_;
  robot::Airframe airframe_;
  FlightReference reference_;
  Separation separation_;
  PoseControl pose_control_;
  ContactWrenchLaw law_;
  DisturbanceFeedback feedback_;
  HandOver hand_over_;  // from the one's feed-forward to the other's
  robot::Allocator allocator_;
  TouchdownDetector touchdown_;
  robot::HoverReach reach_;
  GoalFault refusal_;  // the last one's words
  FlightMode mode_ = FlightMode::disarmed;
  FlightConditions conditions_;
  TimePoint law_updated_{};

  TimePoint epoch_{};  // of `seconds`: the first step
  TimePoint last_step_{};
  bool first_step_ = true;
  bool loaded_ = false;   // from a checkpoint, ...
  TimePoint saved_at_{};  // ... of then
  bool settled_ = false;
  std::optional<bool> rotors_armed_;  // as the hardware host says
  bool gave_up_ = false;              // after a start in the air with nothing to go on from: told
  msg::ModuleState state_;            // the newest
  TimePoint state_at_{};
  ModuleMotion motion_;  // extrapolated to now
  robot::PoseReference flown_;
  std::array<double, robot::joints_max> joint_rad_{};
  robot::Wrench external_W_;
  robot::Wrench common_W_;  // our share of what acts on the whole chain, weighed with the members that are fresh
  robot::ModelErrors errors_ = robot::ModelErrors::Zero();  // of the airframe, as estimation found them
  msg::BaseReference base_;      // the newest of the base of our chain, if its epoch is the view's
  TimePoint base_written_at_{};  // when we are the base
  bool duplicate_id_ = false;
  msg::DockingState docking_;
  msg::ChainView view_;  // the active one
  robot::Allocation allocation_;

  void take_model_errors() noexcept;
  robot::Wrench correction(const robot::Vector3& c_B) const noexcept;
  void take_contact_wrench(const msg::ContactWrench& w, TimePoint now) noexcept;

  Neighbourhood neighbourhood_;

  std::uint64_t goal_id_ = 0;  // the one being flown
  bool goal_is_ours_ = false;  // to answer
  bool goal_pending_ = false;
  msg::ContactGoal contact_goal_now_;
  std::uint64_t answered_mode_ = 0, answered_flight_ = 0, answered_morph_ = 0, answered_contact_ = 0;
  FlightMode reported_mode_ = FlightMode::disarmed;

  std::uint64_t rejected_ = 0;             // references that are none
  std::optional<msg::RotorCommand> sent_;  // in this step
  TimePoint joint_state_at_{}, rotor_state_at_{}, contact_wrench_at_{};
  bool bad_reference_ = false;  // the last one was no pose: told
  runtime::FaultReporter faults_;

  bus::Reader<msg::ModuleState> module_state_;
  bus::Reader<msg::JointState> joint_state_;
  bus::Reader<msg::RotorState> rotor_state_;
  bus::Reader<msg::ExternalWrench> external_wrench_;
  bus::Reader<msg::ContactWrench> contact_wrench_;
  bus::Reader<msg::ModelErrors> model_errors_;
  bus::Reader<msg::ChainView> chain_view_;
  bus::Reader<msg::DockingState> docking_state_;
  bus::Reader<msg::Beacon> beacon_;
  bus::Reader<msg::ModeRequest> mode_request_;
  bus::Reader<msg::FlightGoal> flight_goal_;
  bus::Reader<msg::PathGoal> path_goal_;
  bus::Reader<msg::MorphGoal> morph_goal_;
  bus::Reader<msg::ContactGoal> contact_goal_;
  bus::Reader<msg::DockingReference> docking_reference_;
  bus::Reader<msg::BaseReference> base_reference_;
  bus::Writer<msg::RotorCommand> rotor_command_;
  bus::Writer<msg::BaseReference> base_reference_out_;
  bus::Writer<msg::GoalStatus> goal_status_;
  bus::Writer<msg::Event> event_;
};

}  // namespace eciton::control
