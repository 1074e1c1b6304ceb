// Between the plain arrays of messages and hardware readings and Eigen's types. Quaternions are (w, x, y, z).
#pragma once

#include <array>

#include "core/robot/frames.hpp"

namespace eciton::robot {

inline Vector3 vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }
inline std::array<double, 3> array(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

/// Of a quaternion of any length but zero; zero gives the identity.
inline Matrix3 rotation(const std::array<double, 4>& q) {
  const Quaternion quaternion(q[0], q[1], q[2], q[3]);
  const double norm = quaternion.norm();
  return norm > 1e-9 ? Quaternion(quaternion.coeffs() / norm).toRotationMatrix() : Matrix3(Matrix3::Identity());
}
/// With w >= 0, so that a rotation has one quaternion.
inline std::array<double, 4> quaternion(const Matrix3& R) {
  Quaternion q(R);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace eciton::robot
