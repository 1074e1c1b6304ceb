// A rotation that moves, written as a rotation vector: R = R_0 exp(phi). Turns the vector and its two
// derivatives into attitude, angular velocity and acceleration, analytically.
#pragma once

#include "core/robot/frames.hpp"

namespace eciton::robot {

struct AttitudeMotion {
  Matrix3 R;      // R_0 exp(phi)
  Vector3 w;      // rad/s, in the axes of R (body)
  Vector3 alpha;  // d w / dt, rad/s^2, in the axes of R
};

/// J_r: w = J_r(phi) dphi/dt, in body axes. Valid for |phi| < 2 pi.
Matrix3 right_jacobian(const Vector3& phi);

AttitudeMotion attitude_motion(const Matrix3& R_0, const Vector3& phi, const Vector3& phi_rate,
                               const Vector3& phi_acceleration);

/// The rotation vector of R nearest to `previous`: of the two with |phi| <= 2 pi that turn to R. Keeps a
/// sequence of attitudes continuous beyond half a turn.
Vector3 rotation_vector_near(const Matrix3& R, const Vector3& previous);

}  // namespace eciton::robot
