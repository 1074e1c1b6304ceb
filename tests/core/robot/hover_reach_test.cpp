// Attitudes a module can hover at, against what the thrust vectors of its rotors need by hand.
#include "core/robot/hover_reach.hpp"

#include <gtest/gtest.h>

namespace eciton::robot {
namespace {

Matrix3 about(const Vector3& axis, double angle_rad) { return exp_so3(angle_rad * axis); }

TEST(HoverReachTest, LevelAndTiltedWithinTheGimbalsItHolds) {
  HoverReach reach(legion());
  EXPECT_TRUE(reach.holds(Matrix3::Identity(), Vector3::Zero()));
  EXPECT_TRUE(reach.holds(about(Vector3::UnitZ(), 2.0), Vector3::Zero()));
  EXPECT_TRUE(reach.holds(about(Vector3::UnitX(), 0.8), Vector3::Zero()));
  EXPECT_TRUE(reach.holds(about(Vector3::UnitY(), 0.8), Vector3::Zero()));
}

TEST(HoverReachTest, UpsideDownAndBeyondTheGimbalsItDoesNot) {
  // The gimbals turn by 2.0 rad; the weight is to be carried along a body axis 2.2 or pi rad away from their zero.
  HoverReach reach(legion());
  EXPECT_FALSE(reach.holds(about(Vector3::UnitX(), 3.14159), Vector3::Zero()));
  EXPECT_FALSE(reach.holds(about(Vector3::UnitX(), 2.2), Vector3::Zero()));
  EXPECT_FALSE(reach.holds(about(Vector3(1, 1, 0).normalized(), 2.3), Vector3::Zero()));
}

TEST(HoverReachTest, AnAirframeTooWeakForItsWeightHoldsNothing) {
  Airframe weak = legion();
  for (RotorGeometry& rotor : weak.rotors) rotor.thrust_N_max = 13;  // 12.8 N hover, and nothing to steer with
  HoverReach reach(weak);
  EXPECT_FALSE(reach.holds(Matrix3::Identity(), Vector3::Zero()));
}

TEST(HoverReachTest, TheAnswerDoesNotDependOnWhatWasAskedBefore) {
  HoverReach fresh(legion()), used(legion());
  used.holds(about(Vector3::UnitX(), 1.9), Vector3::Zero());
  used.holds(about(Vector3::UnitY(), -2.5), Vector3::Zero());
  for (double tilt = -2.4; tilt < 2.4; tilt += 0.1) {
    const Matrix3 R = about(Vector3(0.3, 1, 0).normalized(), tilt);
    EXPECT_EQ(fresh.holds(R, Vector3::Zero()), used.holds(R, Vector3::Zero())) << tilt;
  }
}

}  // namespace
}  // namespace eciton::robot
