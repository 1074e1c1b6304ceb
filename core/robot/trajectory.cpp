// Speed profiles, pose motions and splines.
#include "core/robot/trajectory.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::robot {
namespace {

Pose goal_pose(const PoseReference& from) { return {from.p_WM, from.R_WM}; }

bool at_rest(const PoseReference& r) {
  return r.v_WM.norm() + r.a_WM.norm() + r.w_WM_M.norm() + r.alpha_WM_M.norm() < 1e-9;
}

/// x, dx/du, d2x/du2 at u(t), to a reference in time.
PoseReference reference(const Matrix3& R_from, const Vector6& x, const Vector6& x_t, const Vector6& x_tt) {
  const AttitudeMotion attitude = attitude_motion(R_from, x.tail<3>(), x_t.tail<3>(), x_tt.tail<3>());
  return {x.head<3>(), x_t.head<3>(), x_tt.head<3>(), attitude.R, attitude.w, attitude.alpha};
}

}  // namespace

Progress::Progress(SpeedProfile profile, double length_m, double turn_rad, const TrajectoryLimits& limits)
    : profile_(profile) {
  if (length_m < 1e-12 && turn_rad < 1e-12) return;
  if (profile == SpeedProfile::quintic) {
    duration_s_ = std::max(quintic_duration_s(length_m, limits.speed_m_s, limits.acceleration_m_s2),
                           quintic_duration_s(turn_rad, limits.rate_rad_s, limits.angular_acceleration_rad_s2));
    return;
  }
  // In units of the whole way. The cubic ramp of speed peaks at 1.5 times its mean acceleration.
  double speed = 1e9, acceleration = 1e9;
  if (length_m >= 1e-12) {
    speed = limits.speed_m_s / length_m;
    acceleration = limits.acceleration_m_s2 / length_m;
  }
  if (turn_rad >= 1e-12) {
    speed = std::min(speed, limits.rate_rad_s / turn_rad);
    acceleration = std::min(acceleration, limits.angular_acceleration_rad_s2 / turn_rad);
  }
  cruise_ = std::min(speed, std::sqrt(acceleration / 1.5));  // both ramps together cover cruise * ramp <= 1
  ramp_s_ = 1.5 * cruise_ / acceleration;
  duration_s_ = 1 / cruise_ + ramp_s_;
}

ScalarMotion Progress::at(double t_s) const {
  if (t_s <= 0 && duration_s_ > 0) return {0, 0, 0};
  if (t_s >= duration_s_) return {1, 0, 0};
  if (profile_ == SpeedProfile::quintic) return Quintic({0, 0, 0}, 1, duration_s_).at(t_s);
  const auto ramp = [&](double t) -> ScalarMotion {  // from rest up to the cruise
    const double s = t / ramp_s_;
    return {cruise_ * ramp_s_ * s * s * s * (1 - s / 2), cruise_ * s * s * (3 - 2 * s),
            cruise_ / ramp_s_ * 6 * s * (1 - s)};
  };
  if (t_s < ramp_s_) return ramp(t_s);
  if (t_s <= duration_s_ - ramp_s_) return {cruise_ * (t_s - ramp_s_ / 2), cruise_, 0};
  const ScalarMotion back = ramp(duration_s_ - t_s);
  return {1 - back.position, back.velocity, -back.acceleration};
}

PoseMotion::PoseMotion(const Pose& pose) : p_from_(pose.p), R_from_(pose.R) {}

PoseMotion::PoseMotion(const PoseReference& from, const Pose& goal, double start_s, SpeedProfile profile,
                       const TrajectoryLimits& limits)
    : p_from_(from.p_WM),
      p_by_(goal.p - from.p_WM),
      R_from_(from.R_WM),
      phi_by_(log_so3(from.R_WM.transpose() * goal.R)),
      start_s_(start_s),
      straight_(at_rest(from)) {
  progress_ = Progress(profile, p_by_.norm(), phi_by_.norm(), limits);
  if (straight_) return;
  // Near phi = 0 the rotation vector's derivatives are the body's angular velocity and acceleration, so the
  // quintic starts from them as they are. Turns are scaled so that one limit serves all six coordinates.
  const double scale = limits.speed_m_s / limits.rate_rad_s;
  std::array<ScalarMotion, 6> now;
  std::array<double, 6> to;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    now[i] = {0, from.v_WM[k], from.a_WM[k]};
    to[i] = p_by_[k];
    now[i + 3] = {0, scale * from.w_WM_M[k], scale * from.alpha_WM_M[k]};
    to[i + 3] = scale * phi_by_[k];
  }
  const double acceleration = std::min(limits.acceleration_m_s2, scale * limits.angular_acceleration_rad_s2);
  quintic_.go(now, to, start_s, limits.speed_m_s, acceleration);
  turn_unit_ = 1 / scale;
}

PoseMotion PoseMotion::stop(const PoseReference& from, double start_s, const TrajectoryLimits& limits) {
  PoseMotion motion(goal_pose(from));
  motion.start_s_ = start_s;
  if (at_rest(from)) return motion;
  motion.straight_ = false;
  const double scale = limits.acceleration_m_s2 / limits.angular_acceleration_rad_s2;
  std::array<ScalarMotion, 6> now;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    now[i] = {0, from.v_WM[k], from.a_WM[k]};
    now[i + 3] = {0, scale * from.w_WM_M[k], scale * from.alpha_WM_M[k]};
  }
  motion.quintic_.stop(now, start_s, limits.acceleration_m_s2);
  motion.turn_unit_ = 1 / scale;
  return motion;
}

PoseReference PoseMotion::at(double t_s) const {
  Vector6 x, x_t, x_tt;
  if (straight_) {
    const ScalarMotion s = progress_.at(t_s - start_s_);
    Vector6 by;
    by << p_by_, phi_by_;
    x = by * s.position;
    x_t = by * s.velocity;
    x_tt = by * s.acceleration;
  } else {
    for (std::size_t k = 0; k < 6; ++k) {
      const ScalarMotion m = quintic_.at(k, t_s);
      const auto i = static_cast<Eigen::Index>(k);
      const double unit = k < 3 ? 1.0 : turn_unit_;
      x[i] = unit * m.position;
      x_t[i] = unit * m.velocity;
      x_tt[i] = unit * m.acceleration;
    }
  }
  x.head<3>() += p_from_;
  return reference(R_from_, x, x_t, x_tt);
}

PoseSpline::PoseSpline(std::span<const Pose> waypoints, double start_s, SpeedProfile profile,
                       const TrajectoryLimits& limits)
    : count_(std::min(waypoints.size(), waypoints_max)), start_s_(start_s) {
  if (count_ == 0) return;
  R_from_ = waypoints[0].R;
  // The parameter is the time the limits ask for between waypoints, so that speed along the curve is even.
  Vector3 phi = Vector3::Zero();
  for (std::size_t k = 0; k < count_; ++k) {
    phi = rotation_vector_near(R_from_.transpose() * waypoints[k].R, phi);
    x_[k] << waypoints[k].p, phi;
    if (k == 0) continue;
    const Vector6 by = x_[k] - x_[k - 1];
    const double wait = std::max(by.head<3>().norm() / limits.speed_m_s, by.tail<3>().norm() / limits.rate_rad_s);
    u_[k] = u_[k - 1] + std::max(wait, 1e-6);
  }
  solve_curvatures();
  // The limits hold at the points of the curve where it is fastest.
  double length = 0, turn = 0;
  constexpr int samples = 8;
  for (std::size_t k = 1; k < count_; ++k) {
    for (int i = 0; i <= samples; ++i) {
      const Vector6 x_u = curve(u_[k - 1] + (u_[k] - u_[k - 1]) * i / samples).x_u;
      length = std::max(length, x_u.head<3>().norm() * u_[count_ - 1]);
      turn = std::max(turn, x_u.tail<3>().norm() * u_[count_ - 1]);
    }
  }
  progress_ = Progress(profile, length, turn, limits);
}

void PoseSpline::solve_curvatures() {
  // Natural spline: the tridiagonal system for the second derivatives, by Thomas' algorithm.
  std::array<double, waypoints_max> upper{};
  x_uu_.fill(Vector6::Zero());
  for (std::size_t k = 1; k + 1 < count_; ++k) {
    const double before = u_[k] - u_[k - 1], after = u_[k + 1] - u_[k];
    const Vector6 bend = 6 * ((x_[k + 1] - x_[k]) / after - (x_[k] - x_[k - 1]) / before);
    const double pivot = 2 * (before + after) - before * upper[k - 1];
    upper[k] = after / pivot;
    x_uu_[k] = (bend - before * x_uu_[k - 1]) / pivot;
  }
  for (std::size_t k = count_ > 1 ? count_ - 2 : 0; k > 0; --k) x_uu_[k] -= upper[k] * x_uu_[k + 1];
}

PoseSpline::Point PoseSpline::curve(double u) const {
  if (count_ < 2) return {x_[0], Vector6::Zero(), Vector6::Zero()};
  std::size_t k = 1;
  while (k + 1 < count_ && u > u_[k]) ++k;
  const double h = u_[k] - u_[k - 1], b = (u - u_[k - 1]) / h, a = 1 - b;
  const Vector6 &m0 = x_uu_[k - 1], &m1 = x_uu_[k];
  return {a * x_[k - 1] + b * x_[k] + ((a * a * a - a) * m0 + (b * b * b - b) * m1) * (h * h / 6),
          (x_[k] - x_[k - 1]) / h + ((1 - 3 * a * a) * m0 + (3 * b * b - 1) * m1) * (h / 6), a * m0 + b * m1};
}

PoseReference PoseSpline::at(double t_s) const {
  if (count_ == 0) return {};
  const double whole = u_[count_ - 1];
  const ScalarMotion s = progress_.at(t_s - start_s_);
  const Point c = curve(s.position * whole);
  const double u_t = s.velocity * whole, u_tt = s.acceleration * whole;
  return reference(R_from_, c.x, c.x_u * u_t, c.x_uu * (u_t * u_t) + c.x_u * u_tt);
}

}  // namespace eciton::robot
