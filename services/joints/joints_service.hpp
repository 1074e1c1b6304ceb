// Moves this module's dock joints: in a chain as the chain's morph goals say, apart back to zero.
#pragma once

#include <array>
#include <span>

#include "core/base/config.hpp"
#include "core/bus/participant.hpp"
#include "core/robot/joint_trajectory.hpp"
#include "core/runtime/service.hpp"
#include "idl/topics.hpp"
#include "services/joints/joint_relief.hpp"

namespace eciton::joints {

struct JointsConfig {
  std::uint32_t module_id = 0;
  double rate_Hz = 100;
  JointReliefConfig relief;

  template <class V>
  void visit_fields(V& v) {
    v("rate_Hz", rate_Hz, in_range(10, 500));
    v("relief_rate_1_s", relief.rate_1_s, in_range(0, 100));
    v("stiffness_Nm_rad", relief.stiffness_Nm_rad, in_range(1, 1000));
    v("friction_Nm_s_rad", relief.friction_Nm_s_rad, in_range(0, 100));
    v("give_rad", relief.give_rad, in_range(0, 0.2));
    v("return_time_constant_s", relief.return_time_constant_s, in_range(0.05, 100));
  }
};

class JointsService final : public runtime::Service {
 public:
  JointsService(bus::Participant& ring, const JointsConfig& config, const robot::Airframe& airframe);

  std::string_view name() const override { return "joints"; }
  runtime::Schedule schedule() override {
    return runtime::every(from_s(1 / config_.rate_Hz), runtime::Phase::coordinate);
  }
  void step(TimePoint now) noexcept override;
  std::uint32_t state_version() const noexcept override { return 2; }
  void save_state(runtime::StateWriter& writer) const noexcept override { visit_state(*this, writer); }
  void load_state(runtime::StateReader& reader) noexcept override;

 private:
  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.last_step_, self.epoch_, self.trajectory_, self.place_, self.measured_, self.in_chain_, self.view_,
      self.goal_, self.goal_pending_, self.answered_, self.relief_, self.loaded_epoch_);
  }

  /// In a link that shall carry nothing: where contact wrenches are asked for, the joint holds them.
  bool gives_way(std::size_t joint) const;
  double seconds(TimePoint t) const { return to_s(t - epoch_); }
  void begin(TimePoint now) noexcept;
  void take_joints(TimePoint now) noexcept;
  void take_chain(TimePoint now) noexcept;
  void enter_chain(TimePoint now) noexcept;
  void straighten(TimePoint now) noexcept;
  void take_docking(TimePoint now) noexcept;
  void take_goals(TimePoint now) noexcept;
  void write(TimePoint now) noexcept;
  void answer(const msg::MorphGoal& goal, msg::GoalPhase phase, std::string_view reason, TimePoint now) noexcept;

  JointsConfig config_;
  robot::Airframe airframe_;
  robot::JointTrajectory trajectory_;  // in a chain of all members' joints, apart of our own
  std::size_t place_ = 0;              // ours in it
  bool measured_ = false;              // our own positions are known: nothing is commanded before
  bool in_chain_ = false;
  TimePoint epoch_{};
  TimePoint last_step_{};
  bool first_step_ = true;
  bool loaded_ = false;                                      // from a checkpoint
  msg::ChainView view_;                                      // the active one
  std::array<msg::JointState, robot::members_max> heard_{};  // peers' joints
  msg::JointState own_;
  robot::Matrix3 R_WM_ = robot::Matrix3::Identity();
  std::array<JointRelief, robot::joints_max> relief_;
  std::uint64_t loaded_epoch_ = 0;  // of the chain whose contact goal asks for contact wrenches
  msg::MorphGoal goal_;
  bool goal_pending_ = false;
  std::uint64_t answered_ = 0;
  std::uint32_t docking_member_ = 0;  // of our chain, or ourselves: the last that said it is docking, ...
  TimePoint docking_at_{};            // ... and when

  bus::Reader<msg::MorphGoal> morph_goal_;
  bus::Reader<msg::ChainView> chain_view_;
  bus::Reader<msg::JointState> joint_state_;
  bus::Reader<msg::ContactGoal> contact_goal_;
  bus::Reader<msg::ModuleState> module_state_;
  bus::Reader<msg::DockingState> docking_state_;
  bus::Writer<msg::JointCommand> joint_command_;
  bus::Writer<msg::GoalStatus> goal_status_;
};

}  // namespace eciton::joints
