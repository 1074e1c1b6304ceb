// A joint that gives way, against its differential equation solved by hand and a servo that it strains.
#include "services/joints/joint_relief.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace eciton::joints {
namespace {

constexpr double dt_s = 0.002;

TEST(JointReliefTest, WeightByHand) {
  // A pitch joint (+y) that carries 0.2 kg at 0.1 m ahead: gravity pulls the nose down, about +y, by m g l; the servo
  // holds against it. Turned up by 60 degrees (about -y) the lever is half as long; on its side there is none.
  robot::JointGeometry joint{};
  joint.axis_B = {0, 1, 0};
  joint.link_mass_kg = 0.2;
  joint.p_JL_m = {0.1, 0, 0};
  const double full_Nm = 0.2 * robot::gravity_m_s2 * 0.1;
  const robot::Matrix3 level = robot::Matrix3::Identity();
  EXPECT_NEAR(weight_torque_Nm(joint, 0, level), -full_Nm, 1e-12);
  EXPECT_NEAR(weight_torque_Nm(joint, -std::numbers::pi / 3, level), -full_Nm / 2, 1e-12);
  EXPECT_NEAR(weight_torque_Nm(joint, 0, robot::exp_so3({0, -std::numbers::pi / 3, 0})), -full_Nm / 2, 1e-12);
  EXPECT_NEAR(weight_torque_Nm(joint, 0, robot::exp_so3({std::numbers::pi / 2, 0, 0})), 0, 1e-12);
}

TEST(JointReliefTest, TakesTheStrainOutOfAServoThatIsHeld) {
  // Neighbours hold the joint still, 20 mrad off: the servo strains by k (x - e). The strain falls by
  // 1/e in 1 / rate, to what the forgetting leaves: x = - e rate T / (1 + rate T).
  const JointReliefConfig config;
  JointRelief relief(config);
  const double off_rad = 0.020, k = config.stiffness_Nm_rad, a = config.rate_1_s, T = config.return_time_constant_s;
  double x = 0;
  for (int step = 1; step <= 5000; ++step) {
    x = relief.update(k * (x + off_rad), 0, dt_s);
    const double rest = -off_rad * a / (a + 1 / T);
    EXPECT_NEAR(x, rest * (1 - std::exp(-(a + 1 / T) * step * dt_s)), 0.03 * off_rad) << step;
  }
  EXPECT_LT(k * (x + off_rad), 0.1 * k * off_rad);
}

TEST(JointReliefTest, FrictionOfAMorphIsNoStrain) {
  const JointReliefConfig config;
  JointRelief relief(config);
  for (int step = 0; step < 1000; ++step) relief.update(config.friction_Nm_s_rad * 0.1, 0.1, dt_s);
  EXPECT_NEAR(relief.give_rad(), 0, 1e-12);
}

TEST(JointReliefTest, GivesOnlySoMuchAndComesBack) {
  const JointReliefConfig config;
  JointRelief relief(config);
  for (int step = 0; step < 5000; ++step) relief.update(-5, 0, dt_s);
  EXPECT_EQ(relief.give_rad(), config.give_rad);
  EXPECT_EQ(relief.update(std::numeric_limits<double>::quiet_NaN(), 0, dt_s), config.give_rad);
  for (double t_s = 0; t_s < config.return_time_constant_s; t_s += dt_s) relief.let_go(dt_s);
  EXPECT_NEAR(relief.give_rad(), config.give_rad / std::numbers::e, 1e-3 * config.give_rad);
}

TEST(JointReliefTest, ARateOfZeroIsAStiffJoint) {
  JointRelief relief({.rate_1_s = 0});
  EXPECT_EQ(relief.update(5, 0, dt_s), 0);
}

}  // namespace
}  // namespace eciton::joints
