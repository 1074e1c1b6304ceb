// A rigid body's frames against numeric differentiation; smoothing against its closed form.
#include "services/docking/chain_reference.hpp"

#include <gtest/gtest.h>

namespace eciton::docking {
namespace {

using robot::Pose;
using robot::Vector3;

TEST(CarriedAlongTest, MovesAsTheBodyDoes) {
  // By hand: a body that turns about world z at 0.5 rad/s; a frame 2 m ahead of it on its x axis moves sideways.
  MovingPose body;
  body.v_WM = {0.1, 0, 0};
  body.w_WM = {0, 0, 0.5};
  const MovingPose ahead = carried_along(body, {Vector3(2, 0, 0), robot::Matrix3::Identity()});
  EXPECT_TRUE(ahead.X_WM.p.isApprox(Vector3(2, 0, 0)));
  EXPECT_TRUE(ahead.v_WM.isApprox(Vector3(0.1, 1.0, 0)));
}

TEST(CarriedAlongTest, AgreesWithNumericDifferentiation) {
  const Vector3 v_W(0.3, -0.2, 0.1), w_W(0.2, -0.4, 0.7);
  const Pose X_MN{Vector3(-0.8, 0.3, 0.1), robot::exp_so3(Vector3(0.1, 0.5, -0.3))};
  const auto body_at = [&](double t_s) {
    return Pose{Vector3(1, 2, 3) + v_W * t_s, robot::exp_so3(w_W * t_s) * robot::exp_so3(Vector3(0.4, -0.1, 0.8))};
  };
  const double h_s = 1e-5;
  const Pose before = body_at(-h_s) * X_MN, after = body_at(h_s) * X_MN;
  const MovingPose carried = carried_along({body_at(0), v_W, w_W}, X_MN);
  EXPECT_LT((carried.v_WM - (after.p - before.p) / (2 * h_s)).norm(), 1e-8);
  EXPECT_LT((carried.w_WM - robot::log_so3(after.R * before.R.transpose()) / (2 * h_s)).norm(), 1e-8);
  // And back again: the way from a member to its base and from the base to the member are one.
  const MovingPose back = carried_along(carried, X_MN.inverse());
  EXPECT_LT((back.X_WM.p - body_at(0).p).norm(), 1e-12);
  EXPECT_LT((back.v_WM - v_W).norm(), 1e-12);
}

TEST(SmoothedPoseTest, FollowsAStepByItsTimeConstant) {
  SmoothedPose smoothed;
  smoothed.start({});
  const Pose there{Vector3(1, 0, 0), robot::exp_so3(Vector3(0, 0, 0.6))};
  for (int k = 0; k < 50; ++k) smoothed.update(0.01, 0.5, there);
  const double share = 1 - std::exp(-1.0);
  EXPECT_NEAR(smoothed.pose().p.x(), share, 1e-9);
  EXPECT_NEAR(robot::log_so3(smoothed.pose().R).z(), 0.6 * share, 1e-9);
  smoothed.update(0.01, 0, there);
  EXPECT_NEAR(smoothed.pose().p.x(), 1, 1e-12);
}

}  // namespace
}  // namespace eciton::docking
