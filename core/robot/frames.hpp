// Vectors, rotations and wrenches. Monogram names: p_WM is the position of M in W, R_WM turns M's axes
// into W's; a wrench is a force and a moment about a stated point.
#pragma once

#include <Eigen/Dense>

namespace eciton::robot {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Quaternion = Eigen::Quaterniond;

inline constexpr double gravity_m_s2 = 9.81;

/// Pose of a frame B in a frame A: x_A = R_AB x_B + p_AB.
struct Pose {
  Vector3 p = Vector3::Zero();
  Matrix3 R = Matrix3::Identity();

  Vector3 operator*(const Vector3& x) const { return R * x + p; }
  Pose operator*(const Pose& other) const { return {R * other.p + p, R * other.R}; }
  Pose inverse() const { return {-(R.transpose() * p), R.transpose()}; }
};

/// Force and moment about one point, in one set of axes; both are said where it is used.
struct Wrench {
  Vector3 force = Vector3::Zero();
  Vector3 moment = Vector3::Zero();

  /// What a checkpoint keeps: see core/runtime/service_state.hpp; so wherever this is found.
  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.force, self.moment);
  }
  Wrench operator+(const Wrench& o) const { return {force + o.force, moment + o.moment}; }
  Wrench operator-(const Wrench& o) const { return {force - o.force, moment - o.moment}; }
  Wrench operator-() const { return {-force, -moment}; }
  Wrench operator*(double s) const { return {force * s, moment * s}; }
  Wrench& operator+=(const Wrench& o) {
    force += o.force;
    moment += o.moment;
    return *this;
  }
  Wrench& operator-=(const Wrench& o) {
    force -= o.force;
    moment -= o.moment;
    return *this;
  }
};

inline Matrix3 skew(const Vector3& a) {
  Matrix3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// X(a) of docs/frames_and_units.md: the wrench about P as a wrench about O, a = P - O.
inline Wrench shift(const Wrench& about_P, const Vector3& p_OP) {
  return {about_P.force, about_P.moment + p_OP.cross(about_P.force)};
}

/// The same wrench about the same point, from B's axes to A's.
inline Wrench rotate(const Matrix3& R_AB, const Wrench& wrench_B) {
  return {R_AB * wrench_B.force, R_AB * wrench_B.moment};
}

/// exp: rotation vector (rad) to rotation matrix; exact for any length.
inline Matrix3 exp_so3(const Vector3& v) {
  const double angle = v.norm();
  if (angle < 1e-9) return Matrix3::Identity() + skew(v);
  return Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
}

/// log: rotation matrix to rotation vector (rad), angle in [0, pi].
inline Vector3 log_so3(const Matrix3& R) {
  const Eigen::AngleAxisd a(R);
  return a.angle() * a.axis();
}

/// The heading of an attitude without its roll and pitch.
inline Matrix3 upright(const Matrix3& R) {
  return Eigen::AngleAxisd(std::atan2(R(1, 0), R(0, 0)), Vector3::UnitZ()).toRotationMatrix();
}

}  // namespace eciton::robot
