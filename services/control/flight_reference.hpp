// Where a module shall be, moment by moment: it holds, moves to a goal, flies a path or tracks a moving
// reference. In a chain all of that is the base's, and the module flies its own part of it and of the joints'.
// Pure; times are seconds of one clock.
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
  double path_rate_rad_s = 1.5;  // of a path, which turns while it moves
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

  // What follows is of M apart, and of the base's M, as all members know it, in a chain.
  /// Stand at this pose.
  void hold(const robot::Pose& X_WM);
  /// From the present reference to rest at a goal.
  void move(const robot::Pose& X_WM, double speed_m_s, double start_s, double now_s);
  /// From the present reference, which is at rest, through poses to rest at the last one.
  void follow(std::span<const robot::Pose> waypoints, double speed_m_s, double start_s, double now_s);
  /// The ways that these two would fly, to be looked at beforehand.
  robot::PoseMotion way_to(const robot::Pose& X_WM, double speed_m_s, double start_s, double now_s) const;
  robot::PoseSpline way_through(std::span<const robot::Pose> waypoints, double speed_m_s, double start_s,
                                double now_s) const;
  /// What a way of the base means for all members, or for the module alone, at one time of it; how many.
  std::size_t members_on(const robot::PoseReference& way, double t_s, std::span<robot::PoseReference> members) const;
  /// A reference that moves by itself, given again and again.
  void track(const robot::PoseReference& reference, double stamp_s);
  /// Straight down from the present reference, for ever.
  void descend(double speed_m_s, double now_s);

  /// Into a chain, without a jump: from the present reference, given the chain's joint angles (member by member).
  /// The base's reference leads; the others take `X_WM_base`, where they see the base, for it.
  void join(const ChainPlace& place, std::span<const double> joint_rad, const robot::Pose& X_WM_base, double now_s);
  /// At rest in a chain, before it moves: takes what a member has since learnt of where the base stands, so that all
  /// move by the same amount. The own reference stays. Nothing while something moves, and for the base.
  void see_base(const robot::Pose& X_WM_base, double now_s);
  /// In a chain: the joints move and the reference follows. A refusal changes nothing.
  std::optional<robot::LimitFault> morph(std::span<const double> joint_rad, double rate_rad_s, double start_s,
                                         double now_s) {
    return joints_.go(joint_rad, rate_rad_s, now_s, start_s);
  }
  /// Out of the chain, coming to rest from where the reference is now.
  void leave(double now_s);

  robot::PoseReference at(double now_s) const;
  /// In a chain: what the shared base and joints say of every member, the own offset left out.
  void members_at(double now_s, std::span<robot::PoseReference> members) const;
  bool in_chain() const { return in_chain_; }
  const ChainPlace& place() const { return place_; }
  /// Whether the last motion has come to its end.
  bool arrived(double now_s) const;
  /// Also where a tracked reference has been left to stand.
  bool at_rest(double now_s) const {
    return (kind_ == Kind::motion && motion_.finished(now_s)) ||
           (kind_ == Kind::track && now_s - tracked_s_ >= config_.track_hold_s);
  }

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.kind_, self.motion_, self.path_, self.tracked_, self.tracked_s_, self.slip_p_, self.slip_v_,
      self.slip_phi_, self.slip_s_, self.in_chain_, self.place_, self.offset_p_, self.offset_R_, self.slowing_v_,
      self.joined_s_, self.joints_);
  }

 private:
  enum class Kind { motion, path, track, descend };

  robot::PoseReference leading(double now_s) const;
  void stand_by(const robot::PoseReference& own, const robot::Pose& X_WM_base, double now_s);
  robot::PoseReference own_part(double now_s) const;

  robot::Airframe airframe_;
  FlightReferenceConfig config_;
  Kind kind_ = Kind::motion;
  robot::PoseMotion motion_;
  robot::PoseSpline path_;
  robot::PoseReference tracked_;
  double tracked_s_ = 0;
  // From the tracked reference to the one before it, when tracking began: it fades, so that beginning moves nothing.
  robot::Vector3 slip_p_ = robot::Vector3::Zero();
  robot::Vector3 slip_v_ = robot::Vector3::Zero();
  robot::Vector3 slip_phi_ = robot::Vector3::Zero();
  double slip_s_ = 0;

  bool in_chain_ = false;
  ChainPlace place_;
  // From what the shared base says to where this module sees itself, fixed when it joined: the position in the base's
  // axes, the attitude in the module's.
  robot::Vector3 offset_p_ = robot::Vector3::Zero();
  robot::Matrix3 offset_R_ = robot::Matrix3::Identity();
  robot::Vector3 slowing_v_ = robot::Vector3::Zero();  // its speed when it joined, which runs out
  double joined_s_ = 0;
  robot::JointTrajectory joints_;  // of all members
};

}  // namespace eciton::control
