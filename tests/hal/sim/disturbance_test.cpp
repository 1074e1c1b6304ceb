// Gusts, wakes and jets, and how a module differs from its model: statistics and hand computations.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "hal/sim/disturbances.hpp"
#include "hal/sim/mismatch.hpp"
#include "tests/hal/sim/worlds.hpp"

namespace eciton::hal::sim {
namespace {

using robot::Matrix3;
using robot::Vector3;

TEST(UnitGustTest, HasUnitVarianceAndItsTimeConstant) {
  UnitGust gust(Random(3, 1, Purpose::gust));
  double variance = 0, covariance = 0;
  const int n = 1'000'000;  // 2000 time constants
  std::vector<double> x(static_cast<std::size_t>(n));
  for (double& value : x) value = gust.step(2e-3, 1.0).x();
  const std::size_t lag = 500;  // one time constant
  for (std::size_t k = lag; k < x.size(); ++k) {
    variance += x[k] * x[k];
    covariance += x[k] * x[k - lag];
  }
  EXPECT_NEAR(variance / n, 1, 0.1);
  EXPECT_NEAR(covariance / variance, std::exp(-1), 0.06);
}

TEST(JetTest, FollowsMomentumTheoryNearAndARoundJetFar) {
  // 12.8 N on a 127 mm disc: v_i = sqrt(12.8 / (2 * 1.225 * pi * 0.0635^2)) = 20.31 m/s.
  EXPECT_NEAR(jet_speed_m_s(12.8, 1e-6, 0), 20.31, 0.02);
  EXPECT_NEAR(jet_speed_m_s(12.8, 0.5, 0), 2 * 20.31, 0.4);
  EXPECT_NEAR(jet_speed_m_s(12.8, 4, 0) / jet_speed_m_s(12.8, 2, 0), 0.5, 0.01);
  EXPECT_NEAR(jet_speed_m_s(12.8, 2, 0.172) / jet_speed_m_s(12.8, 2, 0), 0.5, 1e-9);
  EXPECT_EQ(jet_speed_m_s(12.8, -0.1, 0), 0);
}

TEST(JetTest, NeverPushesHarderThanTheRotorLifts) {
  for (double axial = 0.05; axial < 5; axial += 0.05) {
    const JetSource jet{{0, 0, 2}, -Vector3::UnitZ(), 12.8};
    const Vector3 force = jet_force_N(jet, {0, 0, 2 - axial});
    EXPECT_LT(force.z(), 0);
    EXPECT_LT(force.norm(), 12.8);
    EXPECT_LT(jet_force_N(jet, {0.8, 0, 2 - axial}).norm(), 0.5);  // beside: next to nothing
    EXPECT_EQ(jet_force_N(jet, {0, 0, 2 + axial}), Vector3::Zero());
  }
}

TEST(WakeTest, FallsWithTheSquareOfTheDistance) {
  EXPECT_DOUBLE_EQ(wake_deviation_N(1, 1), wake_force_N_at_1m);
  EXPECT_DOUBLE_EQ(wake_deviation_N(2, 1), wake_force_N_at_1m / 4);
  EXPECT_DOUBLE_EQ(wake_deviation_N(1, 0), 0);
}

TEST(WorldAirTest, ModuleUnderAnotherIsPushedDown) {
  WorldConfig config = still_world();
  config.wakes = true;
  const auto fall = [&](double x_m) {
    World world(
        config, robot::legion(),
        {{.id = 1, .p_WB_m = {0, 0, 4}, .hovering = true}, {.id = 2, .p_WB_m = {x_m, 0, 3}, .hovering = true}});
    world.advance(at_ms(200));
    return world.truth_pose(2).v_WB_m_s.z();
  };
  EXPECT_LT(fall(0), -0.2);
  EXPECT_GT(fall(3), -0.02);
}

TEST(WorldAirTest, WindPushesWithItsForce) {
  WorldConfig config = still_world();
  config.wind_N = {0, 4, 0};
  World world(config, robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 5}}});
  world.advance(at_ms(200));
  EXPECT_NEAR(world.truth_pose(1).v_WM_m_s.y(), 4 / 3.915 * 0.2, 1e-3);
  world.set_wind(Vector3::Zero());
  world.advance(at_ms(400));
  EXPECT_NEAR(world.truth_pose(1).v_WM_m_s.y(), 4 / 3.915 * 0.2, 5e-3);
}

TEST(WorldAirTest, GustOnAFallingModuleHasItsDeviation) {
  WorldConfig config = still_world();
  config.gust_N = 2;
  config.floor = false;
  double variance = 0, vertical = 0;
  const int n = 60;
  for (int seed = 0; seed < n; ++seed) {  // a hundredth of its time constant: the force is constant
    config.seed = static_cast<std::uint64_t>(seed);
    World world(config, robot::legion(), {{.id = 1}});
    world.advance(at_ms(10));
    const Vector3 force = 3.915 * (world.truth_pose(1).v_WM_m_s / 0.01 + Vector3(0, 0, 9.81));
    variance += force.head<2>().squaredNorm() / (2 * n);
    vertical += force.z() * force.z() / n;
  }
  EXPECT_NEAR(std::sqrt(variance), 2, 0.5);
  EXPECT_NEAR(std::sqrt(vertical), 1, 0.3);
}

TEST(MismatchTest, IsTheSameForOneSeedAndWithinItsBounds) {
  const robot::Airframe airframe = robot::legion();
  double thrust_max = 0, mass_max = 0, com_max = 0, attitude_max = 0, joint_max = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Mismatch m = draw_mismatch(airframe, Random(seed, 1, Purpose::mismatch));
    EXPECT_EQ(m.mass_scale, draw_mismatch(airframe, Random(seed, 1, Purpose::mismatch)).mass_scale);
    EXPECT_NE(m.mass_scale, draw_mismatch(airframe, Random(seed, 2, Purpose::mismatch)).mass_scale);
    for (std::size_t k = 0; k < 3; ++k) thrust_max = std::max(thrust_max, std::abs(m.thrust_scale[k] - 1));
    mass_max = std::max(mass_max, std::abs(m.mass_scale - 1));
    com_max = std::max(com_max, m.p_B_com_m.cwiseAbs().maxCoeff());
    attitude_max = std::max(attitude_max, m.attitude_bias_rad.norm());
    for (std::size_t k = 0; k < 2; ++k) joint_max = std::max(joint_max, std::abs(m.joint_offset_rad[k]));
  }
  EXPECT_NEAR(thrust_max, 0.05, 0.001);
  EXPECT_NEAR(mass_max, 0.03, 0.001);
  EXPECT_NEAR(com_max, 0.0031, 0.0002);
  EXPECT_NEAR(attitude_max, 0.010, 0.0005);
  EXPECT_NEAR(joint_max, 0.020, 0.0005);
}

TEST(MismatchTest, LeavesEveryBodyPhysicallyPossible) {
  const robot::Airframe airframe = robot::legion();
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Mismatch m = draw_mismatch(airframe, Random(seed, 1, Purpose::mismatch));
    const Vector3 moments =
        Eigen::SelfAdjointEigenSolver<Matrix3>(true_inertia(airframe, m).I_body_kg_m2).eigenvalues();
    EXPECT_GT(moments[0], 0);
    EXPECT_GT(moments[0] + moments[1], moments[2]) << "seed " << seed;
  }
}

TEST(MismatchTest, BodyAndLinksAddUpToTheAirframe) {
  const robot::Airframe airframe = robot::legion(true);
  const TrueInertia parts = true_inertia(airframe, Mismatch{});
  const auto point = [](double mass_kg, const Vector3& p) -> Matrix3 {
    return mass_kg * (p.squaredNorm() * Matrix3::Identity() - p * p.transpose());
  };
  double mass_kg = parts.body_mass_kg;
  Vector3 first = parts.body_mass_kg * parts.p_B_body_com_m;
  Matrix3 I = parts.I_body_kg_m2 + point(parts.body_mass_kg, parts.p_B_body_com_m);
  for (const robot::JointGeometry& joint : airframe.joints) {
    mass_kg += joint.link_mass_kg;
    first += joint.link_mass_kg * (joint.p_BJ_m + joint.p_JL_m);
    I += joint.I_L_kg_m2 + point(joint.link_mass_kg, joint.p_BJ_m + joint.p_JL_m);
  }
  EXPECT_NEAR(mass_kg, 4.177, 1e-12);
  EXPECT_LT(first.norm(), 1e-12);
  EXPECT_LT((I - airframe.I_B_kg_m2).norm(), 1e-12);
}

TEST(MismatchTest, WorldWeighsWhatItsMismatchSays) {
  WorldConfig config;
  config.wakes = false;
  World world(config, robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 5}}});
  EXPECT_NE(world.true_mass_kg(1), 3.915);
  world.set_external_wrench(1, {.force = {10, 0, 0}});
  world.advance(at_ms(10));
  EXPECT_NEAR(world.truth_pose(1).v_WM_m_s.x(), 10 / world.true_mass_kg(1) * 0.01, 1e-3 * 0.0255);
}

}  // namespace
}  // namespace eciton::hal::sim
