// Joint goals and what becomes of them: quintics of least jerk, all joints of the chain leaving and arriving
// together, slow enough for a rate limit. Control evaluates the same motion (core/robot/minimum_jerk.hpp) for
// its feed-forward, from the same goal and start time.
#pragma once

#include <optional>
#include <span>

#include "core/robot/joint_limits.hpp"
#include "core/robot/minimum_jerk.hpp"

namespace eciton::robot {

struct JointTrajectoryConfig {
  double rate_rad_s = 0.06;  // default of a goal: a joint's own friction takes 2 Nms/rad of its 0.3 Nm
  double acceleration_rad_s2_max = 0.5;
  double tilt_rad_max = chain_tilt_rad_max;
};

/// Positions of the joints of a chain (or of one module), member by member. Real-time safe after
/// construction; one thread. Times are seconds of any one clock.
class JointTrajectory {
 public:
  explicit JointTrajectory(const Airframe& airframe, const JointTrajectoryConfig& config = {});

  /// At rest at these positions; also tells how many joints there are and which member is the base.
  void reset(std::span<const double> position_rad, std::size_t base);

  /// Takes a goal, to be begun at `start_s` (now or later; until then the present motion goes on).
  /// `rate_rad_s` 0: the default. A refusal changes nothing.
  std::optional<LimitFault> go(std::span<const double> goal_rad, double rate_rad_s, double now_s, double start_s);
  /// To rest as soon as the acceleration allows, then hold.
  void stop(double now_s);

  ScalarMotion at(std::size_t joint, double t_s) const;
  void at(double t_s, std::span<ScalarMotion> out) const;
  std::size_t size() const { return present_.size(); }
  bool finished(double t_s) const;
  double end_s() const;

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.base_, self.present_, self.next_, self.has_next_);
  }

 private:
  Airframe airframe_;
  JointTrajectoryConfig config_;
  std::size_t base_ = 0;
  JointMotion present_, next_;
  bool has_next_ = false;
};

}  // namespace eciton::robot
