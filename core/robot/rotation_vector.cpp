// Kinematics of rotation vectors.
#include "core/robot/rotation_vector.hpp"

#include <cmath>
#include <numbers>

namespace eciton::robot {
namespace {

/// J_r = I - b [phi]x + c [phi]x^2, with b and c and their derivatives by q = |phi|^2. Below 0.1 rad the
/// closed forms lose digits and the series, cut after q^2, are exact to 1e-12.
struct Coefficients {
  double b, c, b_q, c_q;
};
Coefficients coefficients(double q) {
  if (q < 1e-2) {
    return {1. / 2 - q / 24 + q * q / 720 - q * q * q / 40320, 1. / 6 - q / 120 + q * q / 5040 - q * q * q / 362880,
            -1. / 24 + q / 360 - q * q / 13440, -1. / 120 + q / 2520 - q * q / 120960};
  }
  const double t = std::sqrt(q), s = std::sin(t), k = 1 - std::cos(t);
  return {k / q, (t - s) / (q * t), (s * t - 2 * k) / (2 * q * q), (k * t - 3 * (t - s)) / (2 * q * q * t)};
}

}  // namespace

Matrix3 right_jacobian(const Vector3& phi) {
  const Coefficients f = coefficients(phi.squaredNorm());
  const Matrix3 S = skew(phi);
  return Matrix3::Identity() - f.b * S + f.c * S * S;
}

AttitudeMotion attitude_motion(const Matrix3& R_0, const Vector3& phi, const Vector3& phi_rate,
                               const Vector3& phi_acceleration) {
  const Coefficients f = coefficients(phi.squaredNorm());
  const double q_rate = 2 * phi.dot(phi_rate);
  const Matrix3 S = skew(phi), S_rate = skew(phi_rate);
  const Matrix3 J = Matrix3::Identity() - f.b * S + f.c * S * S;
  const Matrix3 J_rate =
      -f.b_q * q_rate * S - f.b * S_rate + f.c_q * q_rate * S * S + f.c * (S_rate * S + S * S_rate);
  return {R_0 * exp_so3(phi), J * phi_rate, J * phi_acceleration + J_rate * phi_rate};
}

Vector3 rotation_vector_near(const Matrix3& R, const Vector3& previous) {
  const Vector3 phi = log_so3(R);
  const double angle = phi.norm();
  if (angle < 1e-9) {
    // No turn, or a full one about the axis before.
    const double turned = previous.norm();
    return turned > std::numbers::pi ? Vector3(previous / turned * 2 * std::numbers::pi) : phi;
  }
  const Vector3 other = phi * (1 - 2 * std::numbers::pi / angle);
  return (other - previous).squaredNorm() < (phi - previous).squaredNorm() ? other : phi;
}

}  // namespace eciton::robot
