// Zeroing against noise of known size.
#include "services/estimation/zeroing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "core/robot/actuator_lag.hpp"

namespace eciton::estimation {
namespace {

using robot::Matrix3;
using robot::Vector3;

constexpr double dt = 0.002;

/// Of a module that hovers level.
robot::BiasJacobian hovering() {
  const robot::Airframe airframe = robot::legion();
  return robot::bias_jacobian(airframe, robot::ActuatorLag(airframe).rotors(), Vector3::Zero(), Matrix3::Identity());
}
const robot::BiasJacobian level = hovering();

TEST(ZeroingTest, FindsTheBiasWithTheQualityItClaims) {
  // Ornstein-Uhlenbeck noise of 0.3 N and 0.15 s, as the observer makes it: the mean over 6 s spreads by
  // 0.3 sqrt(2 0.15 / 6) = 0.067 N.
  double error = 0, claimed = 0;
  constexpr int runs = 60;
  for (unsigned seed = 0; seed < runs; ++seed) {
    std::mt19937 rng(seed);
    std::normal_distribution<double> n(0, 1);
    Zeroing zeroing;
    zeroing.start();
    const double keep = std::exp(-dt / 0.15);
    double noise = 0.3 * n(rng);
    for (int k = 0; k < 4000 && zeroing.phase() == ZeroingPhase::measuring; ++k) {
      noise = keep * noise + 0.3 * std::sqrt(1 - keep * keep) * n(rng);
      zeroing.update({{0.4 + noise, 0, -2}, {0, 0.1, 0}}, level, Vector3::Zero(), Vector3::Zero(), dt);
    }
    ASSERT_EQ(zeroing.phase(), ZeroingPhase::done);
    const robot::Wrench bias = zeroing.bias_M(level);
    error += std::pow(bias.force.x() - 0.4, 2) / runs;
    claimed += std::pow(zeroing.quality_N(), 2) / runs;
    // What was likely before weighs in: a part in a hundred.
    EXPECT_NEAR(bias.force.z(), -2, 0.03);
    EXPECT_NEAR(bias.moment.y(), 0.1, 0.002);
  }
  EXPECT_NEAR(std::sqrt(error), 0.067, 0.02);
  EXPECT_NEAR(std::sqrt(claimed), 0.067, 0.02);
}

TEST(ZeroingTest, MovingMeansMeasuringAnewAndFinallyRefusing) {
  Zeroing zeroing;
  zeroing.start();
  for (int k = 0; k < 1500; ++k) {
    zeroing.update({}, level, Vector3::Zero(), Vector3::Zero(), dt);
  }
  for (int k = 0; k < 10; ++k) {
    zeroing.update({}, level, Vector3(0.5, 0, 0), Vector3::Zero(), dt);
  }
  EXPECT_EQ(zeroing.interruptions(), 1);
  for (int k = 0; k < 2999; ++k) {
    zeroing.update({}, level, Vector3::Zero(), Vector3::Zero(), dt);
  }
  EXPECT_EQ(zeroing.phase(), ZeroingPhase::measuring);
  for (int k = 0; k < 2; ++k) zeroing.update({}, level, Vector3::Zero(), Vector3::Zero(), dt);
  EXPECT_EQ(zeroing.phase(), ZeroingPhase::done);

  zeroing.start();
  for (int k = 0; k < 20000; ++k) zeroing.update({}, level, Vector3(0.5, 0, 0), Vector3::Zero(), dt);
  EXPECT_EQ(zeroing.phase(), ZeroingPhase::refused);
  EXPECT_NE(std::string(zeroing.reason()).find("moving"), std::string::npos);
  EXPECT_TRUE(zeroing.zeroed());  // by the one before
}

TEST(ZeroingTest, RefusesWhatIsTooUnsteadyOrTooSparse) {
  Zeroing zeroing;
  zeroing.start();
  for (int k = 0; k < 3100; ++k) {
    const double swell = 12 * std::sin(k * dt * 0.8);
    zeroing.update({{swell, 0, 0}, Vector3::Zero()}, level, Vector3::Zero(), Vector3::Zero(), dt);
  }
  EXPECT_EQ(zeroing.phase(), ZeroingPhase::refused);
  EXPECT_FALSE(zeroing.zeroed());
  zeroing.start();
  for (int k = 0; k < 100; ++k) zeroing.update({}, level, Vector3::Zero(), Vector3::Zero(), 0.1);
  EXPECT_EQ(zeroing.phase(), ZeroingPhase::refused);
}

}  // namespace
}  // namespace eciton::estimation
