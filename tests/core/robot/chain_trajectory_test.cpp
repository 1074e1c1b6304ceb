// Chain references against the poses of chain_poses, differentiated numerically.
#include "core/robot/chain_trajectory.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace eciton::robot {
namespace {

constexpr std::size_t members = 5, base = 2;

std::array<ScalarMotion, 2 * members> joints_at(double t) {
  std::array<ScalarMotion, 2 * members> q;
  for (std::size_t k = 0; k < q.size(); ++k) {
    const double w = 0.5 + 0.13 * static_cast<double>(k), size = 0.5;
    q[k] = {size * std::sin(w * t), size * w * std::cos(w * t), -size * w * w * std::sin(w * t)};
  }
  return q;
}

PoseReference base_at(double t) {
  const Vector3 phi(0.3 * std::sin(t), 0.2 * std::cos(1.1 * t), 0.5 * t);
  const Vector3 phi_t(0.3 * std::cos(t), -0.22 * std::sin(1.1 * t), 0.5);
  const Vector3 phi_tt(-0.3 * std::sin(t), -0.242 * std::cos(1.1 * t), 0);
  const AttitudeMotion attitude = attitude_motion(Matrix3::Identity(), phi, phi_t, phi_tt);
  return {Vector3(std::sin(t), std::cos(t), t * t / 2),
          Vector3(std::cos(t), -std::sin(t), t),
          Vector3(-std::sin(t), -std::cos(t), 1),
          attitude.R,
          attitude.w,
          attitude.alpha};
}

/// Composite mass centres and attitudes by the existing pose kinematics alone.
std::array<Pose, members> poses_at(double t) {
  const Airframe a = legion();
  const auto q = joints_at(t);
  std::array<double, 2 * members> angles;
  for (std::size_t k = 0; k < q.size(); ++k) angles[k] = q[k].position;
  const std::span all(angles);
  const PoseReference r = base_at(t);
  const Vector3 c = com_offset_B(a, all.subspan(2 * base, 2));
  std::array<Pose, members> X;
  chain_poses(a, base, {r.p_WM - r.R_WM * c, r.R_WM}, angles, X);
  for (std::size_t i = 0; i < members; ++i) X[i].p += X[i].R * com_offset_B(a, all.subspan(2 * i, 2));
  return X;
}

TEST(ChainTrajectoryTest, PosesVelocitiesAndAccelerationsAreThoseOfTheChain) {
  const Airframe a = legion();
  const double h = 1e-4;
  for (const double t : {0.1, 0.7, 1.9, 3.3}) {
    std::array<PoseReference, members> r, earlier, later;
    chain_references(a, base, base_at(t), joints_at(t), r);
    chain_references(a, base, base_at(t - h), joints_at(t - h), earlier);
    chain_references(a, base, base_at(t + h), joints_at(t + h), later);
    const auto before = poses_at(t - h), now = poses_at(t), after = poses_at(t + h);
    for (std::size_t i = 0; i < members; ++i) {
      EXPECT_LT((r[i].p_WM - now[i].p).norm() + (r[i].R_WM - now[i].R).norm(), 1e-12) << i;
      EXPECT_LT((r[i].v_WM - (after[i].p - before[i].p) / (2 * h)).norm(), 1e-6) << i;
      EXPECT_LT((r[i].a_WM - (after[i].p - 2 * now[i].p + before[i].p) / (h * h)).norm(), 1e-6) << i;
      EXPECT_LT((r[i].w_WM_M - log_so3(before[i].R.transpose() * after[i].R) / (2 * h)).norm(), 1e-6) << i;
      EXPECT_LT((r[i].alpha_WM_M - (later[i].w_WM_M - earlier[i].w_WM_M) / (2 * h)).norm(), 1e-6) << i;
    }
  }
}

TEST(ChainTrajectoryTest, TheBaseKeepsItsReferenceAndAnyMemberLeadsBackToIt) {
  const Airframe a = legion();
  const double t = 1.3;
  std::array<PoseReference, members> r;
  chain_references(a, base, base_at(t), joints_at(t), r);
  EXPECT_EQ(r[base].p_WM, base_at(t).p_WM);
  for (std::size_t i = 0; i < members; ++i) {
    const PoseReference back = base_reference_from(a, base, i, r[i], joints_at(t));
    EXPECT_LT((back.p_WM - r[base].p_WM).norm() + (back.v_WM - r[base].v_WM).norm(), 1e-11) << i;
    EXPECT_LT((back.a_WM - r[base].a_WM).norm() + (back.alpha_WM_M - r[base].alpha_WM_M).norm(), 1e-11) << i;
  }
}

TEST(ChainTrajectoryTest, AStraightChainThatYawsMovesItsEndOnACircle) {
  // Two members 0.806 m apart, base yawing at 1 rad/s: the other's speed and centripetal acceleration.
  const Airframe a = legion();
  PoseReference turning;
  turning.w_WM_M = {0, 0, 1};
  std::array<PoseReference, 2> r;
  chain_references(a, 0, turning, std::array<ScalarMotion, 4>{}, r);
  EXPECT_LT((r[1].v_WM - Vector3(0, 0.806, 0)).norm(), 1e-12);
  EXPECT_LT((r[1].a_WM - Vector3(-0.806, 0, 0)).norm(), 1e-12);
}

TEST(ChainTrajectoryTest, CompositeAndBodyAreInverse) {
  const auto q = joints_at(0.8);
  const ComMotion com = com_motion_B(legion(), std::span(q).first(2));
  const PoseReference r = base_at(0.8);
  const PoseReference back = composite_reference(body_motion(r, com), com);
  EXPECT_LT((back.p_WM - r.p_WM).norm() + (back.v_WM - r.v_WM).norm() + (back.a_WM - r.a_WM).norm(), 1e-12);
}

}  // namespace
}  // namespace eciton::robot
