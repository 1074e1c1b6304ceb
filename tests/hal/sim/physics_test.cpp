// The simulated world's motion against closed forms: falling, standing, hovering, lags, mass and moments.
#include <gtest/gtest.h>

#include <cmath>

#include "hal/sim/actuators.hpp"
#include "tests/hal/sim/pilot.hpp"
#include "tests/hal/sim/worlds.hpp"

namespace eciton::hal::sim {
namespace {

using robot::Vector3;

TEST(WorldTest, ModuleWithoutThrustFallsAsAStoneDoes) {
  World world(still_world(), robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 5}}});
  world.advance(at_ms(500));
  // Semi-implicit steps of 1 ms: z = 5 - g (t^2 + t dt) / 2.
  const TruthPose x = world.truth_pose(1);
  EXPECT_NEAR(x.X_WB.p.z(), 5 - 9.81 * (0.25 + 0.5e-3) / 2, 1e-6);
  EXPECT_NEAR(x.v_WM_m_s.z(), -9.81 * 0.5, 1e-6);
  EXPECT_LT(robot::log_so3(x.X_WB.R).norm(), 1e-3);
}

TEST(WorldTest, StartsAtTheTimeItIsGivenAndAdvancesInWholeSteps) {
  WorldConfig config = still_world();
  config.start_ns = 1'700'000'000'000'000'123;
  World world(config, robot::legion(), {{.id = 1}});
  EXPECT_EQ(to_ns(world.now()), 1'700'000'000'000'000'123);
  EXPECT_EQ(world.sense(1).imu.stamp, world.now());
  world.advance(world.now() + 2'900us);
  EXPECT_EQ(to_ns(world.now()), 1'700'000'000'002'000'123);
}

TEST(WorldTest, LandedModuleStandsStillUnderGusts) {
  WorldConfig config;  // honest: uneven masses
  config.gust_N = 2;
  World world(config, robot::legion(), {{.id = 1}, {.id = 2, .p_WB_m = {1.5, 0, 0}, .yaw_rad = 0.3}});
  world.advance(at_ms(1000));
  const TruthPose before = world.truth_pose(1);
  double speed_m_s_max = 0;
  for (int k = 0; k < 5000; ++k) {
    world.advance(world.now() + 1ms);
    speed_m_s_max = std::max(speed_m_s_max, world.truth_pose(1).v_WB_m_s.norm());
  }
  const TruthPose after = world.truth_pose(1);
  EXPECT_LT((after.X_WB.p - before.X_WB.p).norm(), 1e-3);
  EXPECT_LT(speed_m_s_max, 1e-3);
  EXPECT_NEAR(after.X_WB.p.z(), 0.13, 1e-3);
}

TEST(WorldTest, ImuOfALandedModuleReadsGravityFromTheFirstSampleOn) {
  World world(still_world(), robot::legion(), {{.id = 1}});
  const auto down = [&] { return world.sense(1).imu.specific_force_M_m_s2[2]; };
  EXPECT_NEAR(down(), 9.81, 0.2);  // its feet have yet to settle by some micrometres
  world.advance(at_ms(1000));
  EXPECT_NEAR(down(), 9.81, 1e-3);
}

TEST(WorldTest, ModuleTakesOffFromTheFloorAndHovers) {
  World world(still_world(), robot::legion(), {{.id = 1}});
  std::vector<Pilot> pilots{{world, 1}};
  world.advance(at_ms(500));
  const double z = pilots[0].goal.z();
  fly(world, pilots, 4, [&](double t) {
    pilots[0].goal.z() = z + std::min(1.0, 0.5 * t);
    pilots[0].goal_velocity.z() = t < 2 ? 0.5 : 0;
  });
  EXPECT_LT((world.truth_pose(1).p_WM_m - pilots[0].goal).norm(), 5e-3);
  EXPECT_FALSE(world.fault());
}

TEST(WorldTest, HoverTakesTheWeightAndNoMore) {
  World world(still_world(), robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 2}, .hovering = true}});
  std::vector<Pilot> pilots{{world, 1}};
  fly(world, pilots, 3);
  double sum_N = 0;
  for (std::size_t k = 0; k < 3; ++k) sum_N += world.sense(1).rotors[k].thrust_N;
  EXPECT_NEAR(sum_N, 3.915 * 9.81, 0.05);
}

TEST(WorldTest, BatterySagsUnderLoadAndRunsDown) {
  // 25 V, 6 V a minute and 0.5 V of sag while hovering: 24.5 V at first, 23.5 V after ten seconds.
  WorldConfig config = still_world();
  config.battery = {.start_V = 25, .discharge_V_min = 6, .sag_V = 0.5, .noise_V = 0};
  World world(config, robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 1.5}, .hovering = true}});
  EXPECT_NEAR(world.sense(1).rotors[0].battery_V, 24.5, 1e-9);
  std::vector<Pilot> pilots{{world, 1}};
  fly(world, pilots, 10);
  EXPECT_NEAR(world.sense(1).rotors[0].battery_V, 23.5, 0.03);
  EXPECT_NEAR(world.truth_pose(1).p_WM_m.z(), 1.5, 0.01);
  world.cut(1);
  world.advance(world.now() + 200ms);
  EXPECT_NEAR(world.sense(1).rotors[0].battery_V, 24, 0.05) << "without load it recovers the sag";
}

TEST(WorldTest, LandsGentlyAndLiesStillAfterDisarming) {
  World world(still_world(), robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 0.5}, .hovering = true}});
  std::vector<Pilot> pilots{{world, 1}};
  fly(world, pilots, 2.5, [&](double t) { pilots[0].goal.z() = 0.5 - 0.2 * t; });
  pilots[0].frame.armed = false;
  world.actuate(1, pilots[0].frame);
  world.advance(world.now() + 1s);
  EXPECT_NEAR(world.truth_pose(1).X_WB.p.z(), 0.13, 1e-3);
  EXPECT_LT(world.truth_pose(1).v_WB_m_s.norm(), 1e-4);
  EXPECT_LT(world.sense(1).rotors[0].thrust_N, 1e-6);
}

TEST(RotorActuatorTest, FollowsItsCommandWithAFirstOrderLag) {
  const robot::Airframe airframe = robot::legion();
  RotorActuator rotor(airframe.rotors[0]);
  const RotorSetpoint command{.thrust_N = 15, .gimbal_rad = {0.05, -0.05}};
  for (int k = 1; k <= 60; ++k) {
    rotor.step(command, true, 1e-3);
    EXPECT_NEAR(rotor.thrust_N(), 15 * (1 - std::exp(-k * 1e-3 / 0.030)), 1e-9);
    // 0.05 rad is small enough for the rate limit of 3 rad/s not to bind: 0.05 / 0.04 < 3.
    EXPECT_NEAR(rotor.gimbal_rad()[0], 0.05 * (1 - std::exp(-k * 1e-3 / 0.040)), 1e-9);
  }
  for (int k = 0; k < 300; ++k) rotor.step(command, false, 1e-3);
  EXPECT_LT(rotor.thrust_N(), 1e-3);  // disarmed: runs down by itself
}

TEST(RotorActuatorTest, SaturatesRateAngleAndThrust) {
  const robot::Airframe airframe = robot::legion();
  RotorActuator rotor(airframe.rotors[0]);
  for (int k = 0; k < 100; ++k) rotor.step({.thrust_N = 100, .gimbal_rad = {2.5, 1.0}}, true, 1e-3);
  EXPECT_NEAR(rotor.gimbal_rad()[0], 0.3, 1e-9);  // 3 rad/s for 0.1 s
  for (int k = 0; k < 2000; ++k) rotor.step({.thrust_N = 100, .gimbal_rad = {2.5, 1.0}}, true, 1e-3);
  EXPECT_NEAR(rotor.gimbal_rad()[0], 2.0, 1e-6);
  EXPECT_NEAR(rotor.thrust_N(), 21, 1e-6);
  const double nan = std::nan("");
  for (int k = 0; k < 1000; ++k) rotor.step({.thrust_N = nan, .gimbal_rad = {nan, nan}}, true, 1e-3);
  EXPECT_NEAR(rotor.thrust_N(), 0, 1e-6);
  EXPECT_NEAR(rotor.gimbal_rad()[0], 2.0, 1e-6);
}

TEST(RotorActuatorTest, GimbalsTiltTheThrustAsThePapersAnglesSay) {
  const robot::Airframe airframe = robot::legion();
  RotorActuator rotor(airframe.rotors[0]);
  for (int k = 0; k < 3000; ++k) rotor.step({.thrust_N = 10, .gimbal_rad = {0.3, 0.2}}, true, 1e-3);
  const Vector3 expected = robot::exp_so3({0.3, 0, 0}) * robot::exp_so3({0, 0.2, 0}) * Vector3::UnitZ();
  EXPECT_LT((rotor.direction_B() - expected).norm(), 1e-6);
}

TEST(WorldTest, ThrustStepGivesTheMomentumOfTheClosedForm) {
  World world(still_world(), robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 3}, .hovering = true}});
  const robot::Airframe airframe = robot::legion();
  ActuatorFrame frame = hover_frame(LatchCommand::hold);
  const std::array<double, 3> step_N{3, -2, 1};
  for (std::size_t k = 0; k < 3; ++k) set_thrust(frame, k, frame.rotors[k].thrust_N + step_N[k]);
  world.actuate(1, frame);
  const double t = 0.1;
  world.advance(world.now() + from_s(t));
  // Thrust T0 + dT (1 - exp(-t/tau)): its impulse beyond T0 is dT (t - tau (1 - exp(-t/tau))).
  const double impulse_s = t - 0.030 * (1 - std::exp(-t / 0.030));
  Vector3 twist = Vector3::Zero();
  double lift_Ns = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const robot::RotorGeometry& rotor = airframe.rotors[k];
    const Vector3 impulse_Ns(0, 0, airframe.hover_thrust_N() * t + step_N[k] * impulse_s);
    lift_Ns += step_N[k] * impulse_s;
    twist += rotor.p_BR_m.cross(impulse_Ns) + rotor.drag_ratio_m * impulse_Ns;
  }
  const TruthPose x = world.truth_pose(1);
  EXPECT_NEAR(x.v_WM_m_s.z(), lift_Ns / airframe.mass_kg, 0.02 * lift_Ns / airframe.mass_kg);
  const Vector3 w = airframe.I_B_kg_m2.inverse() * twist;
  EXPECT_LT((x.w_WM_M_rad_s - w).norm(), 0.04 * w.norm());
}

TEST(WorldTest, JointFollowsItsRateLimitedReference) {
  World world(still_world(), robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 3}, .hovering = true}});
  std::vector<Pilot> pilots{{world, 1}};
  pilots[0].frame.joints[0].position_rad = 0.8;
  pilots[0].frame.joints[1].position_rad = -0.5;
  fly(world, pilots, 0.2);
  EXPECT_NEAR(world.truth_joint(1, 0).position_rad, 2.6 * 0.2, 0.1);  // on its way: lag of the servo
  fly(world, pilots, 2);
  EXPECT_NEAR(world.truth_joint(1, 0).position_rad, 0.8, 5e-3);
  EXPECT_NEAR(world.truth_joint(1, 1).position_rad, -0.5, 5e-3);
  EXPECT_LT((world.truth_pose(1).p_WM_m - pilots[0].goal).norm(), 0.02);
}

TEST(WorldTest, JointWithoutPowerGivesWay) {
  World world(still_world(), robot::legion(), {{.id = 1}});
  ActuatorFrame frame;
  frame.joints[1].position_rad = 1;
  world.actuate(1, frame);
  world.advance(at_ms(2000));
  EXPECT_EQ(world.truth_joint(1, 1).torque_Nm, 0);
  EXPECT_LT(std::abs(world.truth_joint(1, 1).position_rad), 0.5);
}

TEST(WorldTest, CutStopsMotorsAndJointsOnly) {
  World world(still_world(), robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 3}, .hovering = true}});
  world.actuate(1, hover_frame(LatchCommand::engage));
  world.cut(1);
  world.advance(at_ms(300));
  EXPECT_LT(world.sense(1).rotors[0].thrust_N, 0.01);
  EXPECT_EQ(world.sense(1).latches[0], LatchReading::ready);
}

TEST(WorldTest, RefusesModulesThatCannotBe) {
  const auto message = [](const std::vector<ModuleStart>& starts) -> std::string {
    try {
      World world(still_world(), robot::legion(), starts);
    } catch (const BadInput& bad) {
      return bad.error.message;
    }
    return "";
  };
  EXPECT_NE(message({}).find("0 modules"), std::string::npos);
  EXPECT_NE(message({{.id = 3}, {.id = 3, .p_WB_m = {2, 0, 0}}}).find("id 3"), std::string::npos);
  EXPECT_NE(message({{.id = 3}, {.id = 4}}).find("modules 3 and 4 start less than"), std::string::npos);
  EXPECT_EQ(message({{.id = 3}}), "");
}

}  // namespace
}  // namespace eciton::hal::sim
