// Rotation-vector kinematics against numeric differentiation of the rotation itself.
#include "core/robot/rotation_vector.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace eciton::robot {
namespace {

TEST(RotationVectorTest, VelocityAndAccelerationAreThoseOfTheRotation) {
  const Matrix3 R_0 = exp_so3({0.3, -1, 0.4});
  const Vector3 v(0.5, -0.3, 0.8), a(0.2, 0.6, -0.4);
  for (const double size : {1e-7, 0.05, 0.0999, 0.1001, 1.0, 3.0, 4.5}) {
    const Vector3 phi = Vector3(2, -1, 0.5).normalized() * size;
    const auto R = [&](double t) -> Matrix3 { return R_0 * exp_so3(phi + v * t + a * t * t / 2); };
    const auto w = [&](double t) -> Vector3 {
      const double h = 1e-4;
      return log_so3(R(t - h).transpose() * R(t + h)) / (2 * h);
    };
    const AttitudeMotion m = attitude_motion(R_0, phi, v, a);
    EXPECT_LT((m.R - R(0)).norm(), 1e-12);
    EXPECT_LT((m.w - w(0)).norm(), 1e-7) << size;
    const double h = 1e-3;
    EXPECT_LT((m.alpha - (w(h) - w(-h)) / (2 * h)).norm(), 1e-5) << size;
  }
}

TEST(RotationVectorTest, SeriesAndClosedFormMeet) {
  const Vector3 axis = Vector3(1, 2, 3).normalized(), v(0.1, -0.2, 0.3), a(1, 0, -1);
  const AttitudeMotion below = attitude_motion(Matrix3::Identity(), axis * 0.0999999999, v, a);
  const AttitudeMotion above = attitude_motion(Matrix3::Identity(), axis * 0.1000000001, v, a);
  EXPECT_LT((below.w - above.w).norm(), 1e-9);
  EXPECT_LT((below.alpha - above.alpha).norm(), 1e-8);
}

TEST(RotationVectorTest, StaysContinuousBeyondHalfATurn) {
  Vector3 phi = Vector3::Zero();
  const Vector3 axis = Vector3(1, -1, 2).normalized();
  for (double angle = 0; angle < 1.95 * std::numbers::pi; angle += 0.1) {
    phi = rotation_vector_near(exp_so3(axis * angle), phi);
    EXPECT_LT((phi - axis * angle).norm(), 1e-9) << angle;
  }
}

}  // namespace
}  // namespace eciton::robot
