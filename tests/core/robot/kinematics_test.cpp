// Kinematics against cases worked by hand and against point masses.
#include "core/robot/kinematics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <random>

namespace eciton::robot {
namespace {

constexpr double pi = std::numbers::pi;

TEST(FramesTest, ShiftedWrenchHasTheSamePower) {
  // A rigid body's power does not depend on the point its wrench is written about.
  const Wrench about_P{{1, -2, 3}, {0.3, 0.2, -0.1}};
  const Vector3 p_OP(0.4, -0.5, 0.6), w(0.7, 0.1, -0.9), v_O(0.2, 0.3, -0.4);
  const Vector3 v_P = v_O + w.cross(p_OP);
  const Wrench about_O = shift(about_P, p_OP);
  EXPECT_NEAR(about_P.force.dot(v_P) + about_P.moment.dot(w), about_O.force.dot(v_O) + about_O.moment.dot(w), 1e-12);
}

TEST(FramesTest, LogIsTheInverseOfExp) {
  for (const double angle : {1e-8, 1e-3, 0.5, 2.0, 3.1}) {
    const Vector3 v = Vector3(1, 2, -0.5).normalized() * angle;
    EXPECT_LT((log_so3(exp_so3(v)) - v).norm(), 1e-12) << angle;
  }
}

TEST(KinematicsTest, MassCentreStaysAtBWithTheJointsAtZero) {
  EXPECT_LT(com_offset_B(legion(), std::array{0.0, 0.0}).norm(), 1e-15);
}

TEST(KinematicsTest, MassCentreMovesByTheLinksShareOfItsWay) {
  // Yaw joint by a quarter turn: the male link's centre goes from (x, 0, z) to (0, x, z) from its joint.
  const Airframe a = legion();
  const Vector3 l = a.joints[0].p_JL_m;
  const Vector3 c = com_offset_B(a, std::array{pi / 2, 0.0});
  EXPECT_LT((c - 0.23 / 3.915 * Vector3(-l.x() - l.y(), l.x() - l.y(), 0)).norm(), 1e-15);
}

TEST(KinematicsTest, InertiaIsThatOfAPileOfPointMasses) {
  // A body of two heavy points and one link of two points, its inertia summed up without any theorem.
  Airframe a;
  const std::array<Vector3, 2> body{Vector3(0.3, 0.1, 0), Vector3(-0.2, -0.2, 0.1)};
  const std::array<Vector3, 2> link{Vector3(0.1, 0.05, 0), Vector3(0.2, -0.05, 0.02)};  // from the joint
  const Vector3 p_BJ(0.4, 0, 0.1);
  const auto inertia = [](double m, const Vector3& p) -> Matrix3 { return -m * skew(p) * skew(p); };
  Vector3 centre = Vector3::Zero();
  for (int k = 0; k < 2; ++k) centre += 1.0 * body[k] + 0.25 * (p_BJ + link[k]);
  centre /= 2.5;
  a.mass_kg = 2.5;
  JointGeometry j;
  j.p_BJ_m = p_BJ - centre;  // B's origin at the mass centre
  j.axis_B = Vector3(0.6, 0, 0.8);
  j.link_mass_kg = 0.5;
  j.p_JL_m = (link[0] + link[1]) / 2;
  j.I_L_kg_m2 = inertia(0.25, link[0] - j.p_JL_m) + inertia(0.25, link[1] - j.p_JL_m);
  a.joints.push_back(j);
  a.I_B_kg_m2.setZero();
  for (int k = 0; k < 2; ++k) a.I_B_kg_m2 += inertia(1, body[k] - centre) + inertia(0.25, p_BJ + link[k] - centre);

  const std::array angle{0.8};
  const Matrix3 R = Eigen::AngleAxisd(angle[0], j.axis_B).toRotationMatrix();
  Vector3 c = Vector3::Zero();
  for (int k = 0; k < 2; ++k) c += (body[k] + 0.25 * (p_BJ + R * link[k])) / 2.5;
  Matrix3 I = Matrix3::Zero();
  for (int k = 0; k < 2; ++k) I += inertia(1, body[k] - c) + inertia(0.25, p_BJ + R * link[k] - c);
  EXPECT_LT((com_offset_B(a, angle) - (c - centre)).norm(), 1e-15);
  EXPECT_LT((composite_inertia(a, angle) - I).norm(), 1e-14);
}

TEST(KinematicsTest, StraightChainHasTheModulesPitchOf806Millimetres) {
  std::array<Pose, 4> X;
  chain_poses(legion(), 1, {Vector3(1, 2, 3), Matrix3::Identity()}, std::array<double, 8>{}, X);
  for (std::size_t i = 0; i < 4; ++i) {
    // Male (.4020, .0006, .0084) of one meets female (-.4040, .0006, .0094) of the next.
    const double k = static_cast<double>(i) - 1;
    EXPECT_LT((X[i].p - Vector3(1 + .806 * k, 2, 3 - .001 * k)).norm(), 1e-12) << i;
    EXPECT_TRUE(X[i].R.isIdentity(1e-12));
  }
}

TEST(KinematicsTest, LinkedPortsCoincideWhicheverMemberIsTheBase) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> u(-1, 1);
  std::array<double, 10> q{};
  for (double& x : q) x = u(rng);
  const Airframe a = legion();
  std::array<Pose, 5> X, Y;
  chain_poses(a, 2, {Vector3(0, 0, 2), exp_so3({0.1, 0.2, 0.3})}, q, X);
  for (std::size_t i = 0; i + 1 < 5; ++i) {
    const std::span all(q);
    const Pose male = X[i] * port_pose_B(a, 0, all.subspan(2 * i, 2));
    const Pose female = X[i + 1] * port_pose_B(a, 1, all.subspan(2 * i + 2, 2));
    EXPECT_LT((male.p - female.p).norm() + (male.R - female.R).norm(), 1e-12);
  }
  chain_poses(a, 4, X[4], q, Y);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_LT((X[i].p - Y[i].p).norm() + (X[i].R - Y[i].R).norm(), 1e-12);
}

}  // namespace
}  // namespace eciton::robot
