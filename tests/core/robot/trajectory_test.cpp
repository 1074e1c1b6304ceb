// Pose trajectories: where they lead, that they are smooth, within limits, and what they say of their speed.
#include "core/robot/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace eciton::robot {
namespace {

/// Velocities and accelerations of a trajectory must be the derivatives of its poses.
template <class Trajectory>
void expect_consistent(const Trajectory& trajectory, double tolerance) {
  const double h = 1e-4;
  for (double s = 0.02; s < 0.99; s += 0.0317) {
    const double t = trajectory.start_s() + s * trajectory.duration_s();
    const PoseReference before = trajectory.at(t - h), now = trajectory.at(t), after = trajectory.at(t + h);
    EXPECT_LT((now.v_WM - (after.p_WM - before.p_WM) / (2 * h)).norm(), tolerance);
    EXPECT_LT((now.a_WM - (after.v_WM - before.v_WM) / (2 * h)).norm(), tolerance);
    EXPECT_LT((now.w_WM_M - log_so3(before.R_WM.transpose() * after.R_WM) / (2 * h)).norm(), tolerance);
    EXPECT_LT((now.alpha_WM_M - (after.w_WM_M - before.w_WM_M) / (2 * h)).norm(), tolerance);
  }
}

PoseReference rest(const Vector3& p, const Vector3& rotation) {
  PoseReference r;
  r.p_WM = p;
  r.R_WM = exp_so3(rotation);
  return r;
}

TEST(ProgressTest, TrapezoidCruisesAtTheSpeedAndCoversTheWay) {
  const TrajectoryLimits limits{.speed_m_s = 0.5, .acceleration_m_s2 = 1.5};
  const Progress p(SpeedProfile::trapezoid, 4, 0, limits);
  EXPECT_NEAR(p.duration_s(), 4 / 0.5 + 0.5, 1e-12);  // ramps of 1.5 * 0.5 / 1.5 s at half the speed
  EXPECT_NEAR(4 * p.at(4).velocity, 0.5, 1e-12);
  EXPECT_NEAR(4 * p.at(0.25).acceleration, 1.5, 1e-12);
  EXPECT_EQ(p.at(100).position, 1);
  EXPECT_NEAR(p.at(p.duration_s() - 1e-9).position, 1, 1e-9);
}

TEST(ProgressTest, AShortWayNeverReachesTheSpeed) {
  const TrajectoryLimits limits{.speed_m_s = 2, .acceleration_m_s2 = 1};
  const Progress p(SpeedProfile::trapezoid, 0.1, 0, limits);
  double fastest = 0, hardest = 0;
  for (double t = 0; t < p.duration_s(); t += 1e-3) {
    fastest = std::max(fastest, 0.1 * p.at(t).velocity);
    hardest = std::max(hardest, 0.1 * std::abs(p.at(t).acceleration));
  }
  EXPECT_LT(fastest, 0.3);
  EXPECT_NEAR(hardest, 1, 1e-3);
}

TEST(PoseMotionTest, FromRestItIsStraightTurnsAboutOneAxisAndKeepsItsSpeed) {
  const PoseReference from = rest({1, 2, 3}, {0, 0, 0.4});
  const Pose goal{Vector3(3, 2, 2), exp_so3({0.3, 0, 1.2})};
  for (const SpeedProfile profile : {SpeedProfile::quintic, SpeedProfile::trapezoid}) {
    const PoseMotion motion(from, goal, 7, profile, {.speed_m_s = 0.8});
    expect_consistent(motion, 1e-5);
    for (double t = 7; t < 7 + motion.duration_s(); t += 0.05) {
      const PoseReference r = motion.at(t);
      EXPECT_LE(r.v_WM.norm(), 0.8 + 1e-9);
      EXPECT_LE(r.w_WM_M.norm(), 0.5 + 1e-9);
      EXPECT_LT((r.p_WM - from.p_WM).cross(goal.p - from.p_WM).norm(), 1e-12);
    }
    const PoseReference end = motion.at(1e3);
    EXPECT_LT((end.p_WM - goal.p).norm() + (end.R_WM - goal.R).norm(), 1e-12);
    EXPECT_EQ(end.v_WM.norm() + end.a_WM.norm() + end.w_WM_M.norm(), 0);
    EXPECT_TRUE(motion.finished(7 + motion.duration_s()));
    EXPECT_LT((motion.at(0).p_WM - from.p_WM).norm(), 1e-12);
  }
}

TEST(PoseMotionTest, ANewGoalWhileMovingJoinsOnWithoutAJump) {
  const PoseMotion first(rest({0, 0, 1}, {0, 0, 0}), {Vector3(2, 1, 1), exp_so3({0, 0.5, 1})}, 0,
                         SpeedProfile::quintic, {});
  const double t = 0.4 * first.duration_s();
  const PoseReference now = first.at(t);
  const Pose goal{Vector3(0, 1, 2), Matrix3::Identity()};
  const PoseMotion second(now, goal, t, SpeedProfile::quintic, {});
  const PoseReference joined = second.at(t);
  EXPECT_LT((joined.p_WM - now.p_WM).norm() + (joined.v_WM - now.v_WM).norm() + (joined.a_WM - now.a_WM).norm(),
            1e-9);
  EXPECT_LT((joined.w_WM_M - now.w_WM_M).norm() + (joined.alpha_WM_M - now.alpha_WM_M).norm(), 1e-9);
  expect_consistent(second, 1e-5);
  const PoseReference end = second.at(1e3);
  EXPECT_LT((end.p_WM - goal.p).norm() + (end.R_WM - goal.R).norm(), 1e-9);
}

TEST(PoseMotionTest, StopsWithinItsAccelerationFromWhereItIs) {
  PoseReference now = rest({0, 0, 1}, {0.1, 0, 0});
  now.v_WM = {0.6, -0.2, 0};
  now.w_WM_M = {0, 0, 0.4};
  const PoseMotion motion = PoseMotion::stop(now, 3, {.acceleration_m_s2 = 1.0});
  expect_consistent(motion, 1e-5);
  EXPECT_LT((motion.at(3).v_WM - now.v_WM).norm(), 1e-12);
  for (double t = 3; t < 3 + motion.duration_s(); t += 0.01) {
    EXPECT_LE(motion.at(t).a_WM.cwiseAbs().maxCoeff(), 1 + 1e-9);
    EXPECT_GE(motion.at(t).v_WM.x(), -1e-12);
  }
  EXPECT_EQ(motion.at(100).v_WM.norm(), 0);
}

TEST(PoseMotionTest, HoldsAPoseForEver) {
  const PoseMotion motion(Pose{Vector3(1, 2, 3), exp_so3({0, 0, 1})});
  EXPECT_EQ(motion.at(1e6).p_WM, Vector3(1, 2, 3));
  EXPECT_EQ(motion.at(-1).v_WM.norm(), 0);
  EXPECT_TRUE(motion.finished(0));
}

TEST(PoseSplineTest, PassesItsWaypointsSmoothlyWithinItsLimits) {
  std::vector<Pose> points;
  for (int k = 0; k < 9; ++k) {
    const double u = k * 0.8;
    points.push_back({Vector3(std::sin(u), 0.6 * std::sin(2 * u), 1.5 + 0.3 * std::sin(u)),
                      exp_so3({0.4 * std::sin(u), 0.3 * std::sin(2 * u), 0.5 * u})});
  }
  const TrajectoryLimits limits{.speed_m_s = 0.8, .rate_rad_s = 1};
  const PoseSpline spline(points, 2, SpeedProfile::trapezoid, limits);
  expect_consistent(spline, 2e-4);
  for (const Pose& point : points) {
    double nearest = 1e9;
    for (double t = 2; t < 2 + spline.duration_s(); t += 1e-3) {
      const PoseReference r = spline.at(t);
      nearest = std::min(nearest, (r.p_WM - point.p).norm() + (r.R_WM - point.R).norm());
      EXPECT_LE(r.v_WM.norm(), 0.8 * 1.02);
      EXPECT_LE(r.w_WM_M.norm(), 1.0 * 1.05);
    }
    EXPECT_LT(nearest, 2e-3);
  }
  EXPECT_EQ(spline.at(2).v_WM.norm(), 0);
  EXPECT_LT((spline.at(1e3).p_WM - points.back().p).norm(), 1e-12);
}

TEST(PoseSplineTest, OneWaypointIsAPlaceToStay) {
  const std::array one{Pose{Vector3(1, 0, 0), Matrix3::Identity()}};
  const PoseSpline spline(one, 0, SpeedProfile::quintic, {});
  EXPECT_EQ(spline.at(1).p_WM, Vector3(1, 0, 0));
  EXPECT_TRUE(spline.finished(0));
}

}  // namespace
}  // namespace eciton::robot
