// The lag model against its closed form.
#include "core/robot/actuator_lag.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace eciton::robot {
namespace {

TEST(ActuatorLagTest, ThrustFollowsAStepExponentiallyAtAnyTimeStep) {
  for (const double dt : {0.001, 0.002, 0.015}) {
    ActuatorLag lag(legion());
    std::array<RotorOutput, 3> command{};
    for (RotorOutput& r : command) r.thrust_N = 10;
    lag.set(command);
    for (RotorOutput& r : command) r.thrust_N = 15;
    for (double t = 0; t < 0.03 - 1e-9; t += dt) lag.update(command, dt);
    EXPECT_NEAR(lag.rotors()[1].thrust_N, 15 - 5 * std::exp(-1), 1e-9);
  }
}

TEST(ActuatorLagTest, GimbalsTurnNoFasterThanTheirRate) {
  ActuatorLag lag(legion());
  std::array<RotorOutput, 3> command{};
  for (RotorOutput& r : command) r.gimbal_rad = {1.5, -1.5};
  for (int i = 0; i < 50; ++i) lag.update(command, 0.002);
  EXPECT_NEAR(lag.rotors()[0].gimbal_rad[0], 0.1 * 3.0, 1e-9);
  EXPECT_NEAR(lag.rotors()[0].gimbal_rad[1], -0.1 * 3.0, 1e-9);
  for (int i = 0; i < 1000; ++i) lag.update(command, 0.002);
  EXPECT_NEAR(lag.rotors()[0].gimbal_rad[0], 1.5, 1e-6);
}

TEST(ActuatorLagTest, BeginsInHover) {
  const Airframe a = legion();
  EXPECT_NEAR(ActuatorLag(a).wrench_B(Vector3::Zero()).force.z(), a.mass_kg * gravity_m_s2, 1e-9);
}

}  // namespace
}  // namespace eciton::robot
