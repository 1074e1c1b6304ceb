// The simulated world's motion against closed forms: falling, hovering, standing, lags, mass and moments.
#include <gtest/gtest.h>

#include <cmath>

#include "hal/sim/world.hpp"
#include "tests/hal/sim/pilot.hpp"

namespace eciton::hal::sim {
namespace {

using robot::Vector3;

WorldConfig still_world() {
  WorldConfig config;
  config.world = "ideal";
  config.wakes = false;
  config.noise = 0;
  return config;
}

TEST(WorldTest, ModuleWithoutThrustFallsAsAStoneDoes) {
  World world(still_world(), robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 5}}});
  world.advance(from_ns(500'000'000));
  // Semi-implicit steps of 1 ms: z = 5 - g (t^2 + t dt) / 2.
  const TruthPose x = world.truth_pose(1);
  EXPECT_NEAR(x.X_WB.p.z(), 5 - 9.81 * (0.25 + 0.5e-3) / 2, 1e-6);
  EXPECT_NEAR(x.v_WM_m_s.z(), -9.81 * 0.5, 1e-6);
  EXPECT_LT(robot::log_so3(x.X_WB.R).norm(), 1e-3);
}

TEST(WorldTest, LandedModuleStandsStill) {
  WorldConfig config;  // honest: uneven masses, and gusts that push
  config.gust_N = 2;
  World world(config, robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 0}}, {.id = 2, .p_WB_m = {1.5, 0, 0}}});
  world.advance(from_ns(1'000'000'000));
  const TruthPose before = world.truth_pose(1);
  double speed_m_s_max = 0;
  for (int k = 0; k < 5000; ++k) {
    world.advance(world.now() + 1ms);
    speed_m_s_max = std::max(speed_m_s_max, world.truth_pose(1).v_WB_m_s.norm());
  }
  const TruthPose after = world.truth_pose(1);
  EXPECT_LT((after.X_WB.p - before.X_WB.p).norm(), 1e-3);
  EXPECT_LT(speed_m_s_max, 5e-3);
  EXPECT_NEAR(after.X_WB.p.z(), 0.13, 1e-3);
}

TEST(WorldTest, ModuleTakesOffFromTheFloorAndHovers) {
  World world(still_world(), robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 0}}});
  std::vector<Pilot> pilots{{world, 1}};
  world.advance(from_ns(500'000'000));
  const double z = pilots[0].goal.z();
  fly(world, pilots, 4, [&](double t) {
    pilots[0].goal.z() = z + std::min(1.0, 0.5 * t);
    pilots[0].goal_velocity.z() = t < 2 ? 0.5 : 0;
  });
  EXPECT_LT((world.truth_pose(1).p_WM_m - pilots[0].goal).norm(), 5e-3);
  EXPECT_FALSE(world.fault());
}

}  // namespace
}  // namespace eciton::hal::sim
