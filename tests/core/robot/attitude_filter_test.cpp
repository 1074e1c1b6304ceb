// The attitude filter on a turning body whose attitude is known.
#include "core/robot/attitude_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace eciton::robot {
namespace {

double tilt_error(const Matrix3& R, const Matrix3& truth) {
  return std::acos(std::min(1.0, R.row(2).dot(truth.row(2))));
}

TEST(AttitudeFilterTest, FirstSampleLevelsIt) {
  AttitudeFilter filter;
  const Matrix3 R = exp_so3({0.3, -0.2, 0});
  filter.update(Vector3::Zero(), R.transpose() * Vector3(0, 0, 9.81), 0.002);
  EXPECT_LT(tilt_error(filter.R_WB(), R), 1e-3);
}

TEST(AttitudeFilterTest, FollowsTurnsAndLearnsTheGyroscopesBias) {
  AttitudeFilter filter;
  Matrix3 R = Matrix3::Identity();
  filter.set(exp_so3({0.05, 0, 0}));
  const Vector3 bias(0.01, -0.008, 0);
  const double dt = 0.002;
  for (int i = 0; i < 60000; ++i) {
    const double t = i * dt;
    const Vector3 w(0.4 * std::sin(t), 0.3 * std::cos(0.7 * t), 0);
    R = R * exp_so3(w * dt);
    filter.update(w + bias, R.transpose() * Vector3(0, 0, 9.81), dt);
  }
  EXPECT_LT(tilt_error(filter.R_WB(), R), 0.005);
  EXPECT_LT((filter.bias_rad_s() - bias).head<2>().norm(), 0.003);
}

TEST(AttitudeFilterTest, IgnoresTheAccelerometerWhileItIsNotGravity) {
  AttitudeFilter filter;
  filter.set(Matrix3::Identity());
  for (int i = 0; i < 500; ++i) filter.update(Vector3::Zero(), Vector3(8, 0, 9.81), 0.002);
  EXPECT_LT(tilt_error(filter.R_WB(), Matrix3::Identity()), 1e-9);
}

}  // namespace
}  // namespace eciton::robot
