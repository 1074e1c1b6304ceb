// Where a module shall be, moment by moment: apart, it holds, moves to a goal or tracks a moving one; in a
// chain it flies its own part of the base's motion and of the joints'. Pure; times are seconds of one clock.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/robot/chain_trajectory.hpp"
#include "core/robot/joint_trajectory.hpp"
#include "core/robot/trajectory.hpp"

namespace eciton::control {

struct FlightReferenceConfig {
  double speed_m_s = 0.5;     // of a goto without one
  double track_hold_s = 0.2;  // a tracked reference older than this stands still
  robot::TrajectoryLimits limits;
};

/// A module's place in a chain.
struct ChainPlace {
  std::size_t members = 1;
  std::size_t own = 0;
  std::size_t base = 0;
};

class FlightReference {
 public:
  FlightReference(const robot::Airframe& airframe, const FlightReferenceConfig& config);

  /// Apart: stand at this pose of M.
  void hold(const robot::Pose& X_WM);
  /// Apart: from the present reference to rest at a goal.
  void move(const robot::Pose& X_WM, double speed_m_s, double now_s);
  /// Apart: a reference that moves by itself, given again and again.
  void track(const robot::Pose& X_WM, const robot::Vector3& v_WM, double stamp_s);
  /// Apart: straight down from the present reference, for ever.
  void descend(double speed_m_s, double now_s);

  /// Into a chain, without a jump: from the present reference, which fixes where this module sees the base,
  /// given the chain's joint angles (member by member).
  void join(const ChainPlace& place, std::span<const double> joint_rad, const robot::Pose& X_WM_base, double now_s);
  /// In a chain: the base (as all members know it) moves to a goal pose of its M.
  void move_base(const robot::Pose& X_WM_goal, double speed_m_s, double start_s, double now_s);
  /// In a chain: the joints move and the reference follows. A refusal changes nothing.
  std::optional<robot::LimitFault> morph(std::span<const double> joint_rad, double rate_rad_s, double start_s,
                                         double now_s) {
    return joints_.go(joint_rad, rate_rad_s, now_s, start_s);
  }
  /// Out of the chain, standing where the reference is now.
  void leave(double now_s);

  robot::PoseReference at(double now_s) const;
  bool in_chain() const { return in_chain_; }
  /// Whether the last motion has come to its end.
  bool arrived(double now_s) const;

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.kind_, self.motion_, self.tracked_, self.tracked_s_, self.in_chain_, self.place_, self.offset_p_,
      self.offset_R_, self.joints_);
  }

 private:
  enum class Kind { motion, track, descend };

  robot::PoseReference own_part(double now_s) const;

  robot::Airframe airframe_;
  FlightReferenceConfig config_;
  Kind kind_ = Kind::motion;
  robot::PoseMotion motion_;  // apart: of M; in a chain: of the base's M, as all members know it
  robot::PoseReference tracked_;
  double tracked_s_ = 0;

  bool in_chain_ = false;
  ChainPlace place_;
  robot::Vector3 offset_p_ = robot::Vector3::Zero();      // from what the shared base says to where this
  robot::Matrix3 offset_R_ = robot::Matrix3::Identity();  // module sees itself, fixed when it joined
  robot::JointTrajectory joints_;                         // of all members
};

}  // namespace eciton::control
