// A member's part of a chain's motion, against rigid bodies turned by hand and numeric differentiation.
#include "services/control/flight_reference.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

namespace eciton::control {
namespace {

using robot::Pose;
using robot::PoseReference;
using robot::Vector3;

constexpr std::array<double, 4> straight{};  // joints of two members
const Pose X_WM_base{Vector3(0, 0, 1.5), robot::Matrix3::Identity()};
/// Behind the base, and beside where straight joints would put it, as a chain of crooked links is.
const Pose X_WM_member{Vector3(-0.8, 0.06, 1.52), robot::Matrix3::Identity()};

FlightReference in_chain(std::size_t own, const Pose& X_WM, const Pose& X_WM_base_seen) {
  FlightReference reference(robot::legion(), {});
  reference.hold(X_WM);
  reference.join({.members = 2, .own = own, .base = 0}, straight, X_WM_base_seen, 0);
  return reference;
}

TEST(FlightReferenceTest, JoiningMovesNothing) {
  const FlightReference member = in_chain(1, X_WM_member, X_WM_base);
  EXPECT_LT((member.at(0).p_WM - X_WM_member.p).norm(), 1e-12);
}

TEST(FlightReferenceTest, AMemberTurnsWithTheBaseAsOneBody) {
  FlightReference member = in_chain(1, X_WM_member, X_WM_base);
  const Pose goal{Vector3(2, 1, 1.7), robot::exp_so3({0, 0, std::numbers::pi / 2})};
  member.move(goal, 0.5, 0, 0);
  // A quarter turn to the left takes (x, y) to (-y, x).
  const Vector3 lever = X_WM_member.p - X_WM_base.p;
  const Vector3 expected = goal.p + Vector3(-lever.y(), lever.x(), lever.z());
  EXPECT_TRUE(member.arrived(60));
  EXPECT_LT((member.at(60).p_WM - expected).norm(), 1e-9);
}

TEST(FlightReferenceTest, VelocityAndAccelerationAreTheDerivatives) {
  FlightReference member = in_chain(1, X_WM_member, X_WM_base);
  member.move({Vector3(1, -1, 1.2), robot::exp_so3({0.1, -0.2, 1.0})}, 0.5, 0, 0);
  constexpr double h = 1e-4;
  for (const double t : {0.7, 1.3, 2.0}) {
    const PoseReference before = member.at(t - h), now = member.at(t), after = member.at(t + h);
    EXPECT_LT((now.v_WM - (after.p_WM - before.p_WM) / (2 * h)).norm(), 1e-6) << t;
    EXPECT_LT((now.a_WM - (after.v_WM - before.v_WM) / (2 * h)).norm(), 1e-5) << t;
    EXPECT_GT(now.w_WM_M.norm(), 0.01) << "it does not turn at " << t << " s: the case shows nothing";
  }
}

/// Farthest that the distance vector between the two strays on a path that does not turn.
double strays_m(const FlightReference& base, const FlightReference& member) {
  const Vector3 lever = X_WM_member.p - X_WM_base.p;
  double most_m = 0;
  for (double t = 0; t < 20; t += 0.05) {
    most_m = std::max(most_m, (member.at(t).p_WM - base.at(t).p_WM - lever).norm());
  }
  return most_m;
}

TEST(FlightReferenceTest, AllFlyThePathOfTheBasesReferenceWhereverTheySeeIt) {
  const std::array path{Pose{Vector3(0.5, 0.3, 1.5), robot::Matrix3::Identity()},
                        Pose{Vector3(1, -0.3, 1.6), robot::Matrix3::Identity()}};
  const Pose seen{X_WM_base.p + Vector3(0.006, 0, 0), X_WM_base.R};
  FlightReference base = in_chain(0, X_WM_base, X_WM_base);
  base.follow(path, 0.3, 0, 0);
  FlightReference deceived = in_chain(1, X_WM_member, seen), told = in_chain(1, X_WM_member, seen);
  told.see_base(X_WM_base, 0);
  deceived.follow(path, 0.3, 0, 0);
  told.follow(path, 0.3, 0, 0);
  EXPECT_LT(strays_m(base, told), 1e-9);
  EXPECT_GT(strays_m(base, deceived), 0.003);  // or nothing was shown
}

}  // namespace
}  // namespace eciton::control
