// Trajectories of a pose: a straight line or a curve through waypoints, flown at a given speed, with
// velocity and acceleration for feed-forward. Source: "Trajectory", LEGION; numbers (15).
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/robot/minimum_jerk.hpp"
#include "core/robot/rotation_vector.hpp"

namespace eciton::robot {

/// Where M shall be and how it shall move. p, v, a in world axes; w and alpha in the axes of R_WM.
struct PoseReference {
  Vector3 p_WM = Vector3::Zero();
  Vector3 v_WM = Vector3::Zero();
  Vector3 a_WM = Vector3::Zero();
  Matrix3 R_WM = Matrix3::Identity();
  Vector3 w_WM_M = Vector3::Zero();
  Vector3 alpha_WM_M = Vector3::Zero();

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.p_WM, self.v_WM, self.a_WM, self.R_WM, self.w_WM_M, self.alpha_WM_M);
  }
};

enum class SpeedProfile {
  quintic,   // least jerk; peak speed 1.875 times the mean
  trapezoid  // ramps of least jerk in speed, and a cruise between: sooner there over long ways
};

struct TrajectoryLimits {
  double speed_m_s = 0.5;
  double acceleration_m_s2 = 1.0;
  double rate_rad_s = 0.5;
  double angular_acceleration_rad_s2 = 1.5;
};

/// A way from 0 to 1 from rest to rest, as a function of time.
class Progress {
 public:
  Progress() = default;
  /// `length` and `turn` are what the whole way measures, m and rad: both keep their limits.
  Progress(SpeedProfile profile, double length_m, double turn_rad, const TrajectoryLimits& limits);

  ScalarMotion at(double t_s) const;
  double duration_s() const { return duration_s_; }

 private:
  SpeedProfile profile_ = SpeedProfile::quintic;
  double duration_s_ = 0;
  double ramp_s_ = 0;  // trapezoid only
  double cruise_ = 0;  // speed between the ramps, 1/s
};

/// To a goal pose at rest; straight, and turning about one fixed axis, when it begins at rest. Begun while
/// moving (a new goal, or a stop) it is a quintic that joins on without a jump in velocity or acceleration.
class PoseMotion {
 public:
  PoseMotion() = default;
  /// At rest at `pose` for ever.
  explicit PoseMotion(const Pose& pose);
  PoseMotion(const PoseReference& from, const Pose& goal, double start_s, SpeedProfile profile,
             const TrajectoryLimits& limits);
  /// To rest, wherever that is within the limits' accelerations.
  static PoseMotion stop(const PoseReference& from, double start_s, const TrajectoryLimits& limits);

  PoseReference at(double t_s) const;
  double start_s() const { return start_s_; }
  double duration_s() const { return straight_ ? progress_.duration_s() : quintic_.duration_s(); }
  bool finished(double t_s) const { return t_s >= start_s_ + duration_s(); }

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.p_from_, self.p_by_, self.R_from_, self.phi_by_, self.start_s_, self.straight_, self.progress_,
      self.quintic_, self.turn_unit_);
  }

 private:
  Vector3 p_from_ = Vector3::Zero(), p_by_ = Vector3::Zero();
  Matrix3 R_from_ = Matrix3::Identity();
  Vector3 phi_by_ = Vector3::Zero();
  double start_s_ = 0;
  bool straight_ = true;
  Progress progress_;
  JointMotion quintic_;  // p, then phi in units of `turn_unit_`
  double turn_unit_ = 1;
};

inline constexpr std::size_t waypoints_max = 33;

/// Through waypoints from rest to rest: position and orientation each a natural cubic spline, parametrised
/// by the length (or turn) between waypoints, driven along by a speed profile. Attitudes together must stay
/// within a full turn of the first.
class PoseSpline {
 public:
  PoseSpline() = default;
  /// 2 to `waypoints_max` waypoints; further ones are left out.
  PoseSpline(std::span<const Pose> waypoints, double start_s, SpeedProfile profile, const TrajectoryLimits& limits);

  PoseReference at(double t_s) const;
  double start_s() const { return start_s_; }
  double duration_s() const { return progress_.duration_s(); }
  bool finished(double t_s) const { return t_s >= start_s_ + duration_s(); }

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    for (auto& x : self.x_) v(x);
    for (auto& x_uu : self.x_uu_) v(x_uu);
    v(self.u_, self.count_, self.R_from_, self.start_s_, self.progress_);
  }

 private:
  struct Point {
    Vector6 x, x_u, x_uu;
  };
  Point curve(double u) const;
  void solve_curvatures();

  std::array<Vector6, waypoints_max> x_{};     // p, rotation vector from the first attitude
  std::array<Vector6, waypoints_max> x_uu_{};  // second derivatives at the waypoints
  std::array<double, waypoints_max> u_{};
  std::size_t count_ = 0;
  Matrix3 R_from_ = Matrix3::Identity();
  double start_s_ = 0;
  Progress progress_;
};

}  // namespace eciton::robot
