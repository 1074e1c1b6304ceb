// Same seed, same bits; other seed, others; noise streams that do not know of each other; no allocation.
#include <gtest/gtest.h>

#include "tests/allocation_guard/allocation_guard.hpp"
#include "tests/hal/sim/pilot.hpp"
#include "tests/hal/sim/worlds.hpp"

namespace eciton::hal::sim {
namespace {

using robot::Vector3;

/// Everything a module's host can see, and where the module is.
void append(const World& world, std::uint32_t id, std::vector<double>& out) {
  const SensorFrame f = world.sense(id);
  out.insert(out.end(), f.imu.specific_force_M_m_s2.begin(), f.imu.specific_force_M_m_s2.end());
  out.insert(out.end(), f.imu.w_WM_M_rad_s.begin(), f.imu.w_WM_M_rad_s.end());
  out.insert(out.end(), f.pose.p_WB_m.begin(), f.pose.p_WB_m.end());
  out.insert(out.end(), f.pose.q_WB.begin(), f.pose.q_WB.end());
  for (const RotorReading& r : f.rotors) out.insert(out.end(), {r.thrust_N, r.gimbal_rad[0], r.gimbal_rad[1]});
  for (const JointReading& j : f.joints) out.insert(out.end(), {j.position_rad, j.velocity_rad_s, j.torque_Nm});
  for (const LatchReading l : f.latches) out.push_back(static_cast<double>(l));
  const TruthPose x = world.truth_pose(id);
  out.insert(out.end(), x.X_WB.p.data(), x.X_WB.p.data() + 3);
  out.insert(out.end(), x.X_WB.R.data(), x.X_WB.R.data() + 9);
}

WorldConfig rough_world(std::uint64_t seed) {
  WorldConfig config;
  config.seed = seed;
  config.gust_N = 1;
  config.sensing = "lio";
  return config;
}

/// A docking of two modules in gusts; `asked` readings are taken in between that nobody uses.
std::vector<double> docking(std::uint64_t seed, bool asked = false) {
  World world(rough_world(seed), robot::legion(), nose_to_tail({0.03, 0.01, 0}));
  std::vector<Pilot> pilots{{world, 1}, {world, 2}};
  for (Pilot& pilot : pilots) pilot.frame.latches = {LatchCommand::engage, LatchCommand::engage};
  std::vector<double> out;
  fly(world, pilots, 1.5, [&](double t) {
    pilots[1].goal.x() = legion_port(0).p.x() - legion_port(1).p.x() + std::max(-0.03, 0.03 - 0.1 * t);
    if (asked) (void)world.truth_contact(1, 0), (void)world.sense(2), (void)world.truth_pose(1);
    append(world, 1, out);
    append(world, 2, out);
  });
  out.push_back(world.latched_links());
  return out;
}

TEST(DeterminismTest, SameSeedGivesTheSameBits) {
  const std::vector<double> first = docking(1);
  EXPECT_EQ(first.back(), 1);  // they did dock
  EXPECT_EQ(first, docking(1));
}

TEST(DeterminismTest, OtherSeedGivesOthers) { EXPECT_NE(docking(1), docking(2)); }

TEST(DeterminismTest, LookingChangesNothing) { EXPECT_EQ(docking(1), docking(1, true)); }

/// What the sensors of modules 1 and 2, standing on the floor, add to the truth.
std::vector<double> noise_of_two(bool third) {
  WorldConfig config;
  config.wakes = false;
  std::vector<ModuleStart> starts{{.id = 1}, {.id = 2, .p_WB_m = {1.5, 0, 0}}};
  if (third) starts.insert(starts.begin(), {.id = 3, .p_WB_m = {40, 0, 3}, .hovering = true});
  World world(config, robot::legion(), starts);
  std::vector<double> out;
  std::array<TruthPose, 2> before;
  for (int k = 0; k < 50; ++k) {
    world.advance(world.now() + 10ms);  // the period and the latency of the pose sensor
    for (const std::uint32_t id : {1U, 2U}) {
      const SensorFrame frame = world.sense(id);
      const TruthPose now = world.truth_pose(id);
      if (k > 0) {
        EXPECT_EQ(frame.pose.stamp, before[id - 1].stamp);
        const Vector3 p = Vector3(frame.pose.p_WB_m.data()) - before[id - 1].X_WB.p;
        const Vector3 w = Vector3(frame.imu.w_WM_M_rad_s.data()) - now.w_WM_M_rad_s;
        out.insert(out.end(), {p.x(), p.y(), p.z(), w.x(), w.y(), w.z()});
        out.push_back(frame.joints[0].position_rad - world.truth_joint(id, 0).position_rad);
      }
      before[id - 1] = now;
    }
  }
  return out;
}

TEST(DeterminismTest, OneMoreModuleLeavesTheNoiseOfTheOthersAlone) {
  const std::vector<double> two = noise_of_two(false), three = noise_of_two(true);
  ASSERT_EQ(two.size(), three.size());
  for (std::size_t k = 0; k < two.size(); ++k) ASSERT_NEAR(two[k], three[k], 1e-12) << k;
}

TEST(RealTimeTest, SteppingSensingAndActuatingDoNotAllocate) {
  if (!testing::AllocationGuard::available()) GTEST_SKIP();
  std::vector<ModuleStart> starts = nose_to_tail({0.001, 0, 0});
  starts.push_back({.id = 3, .p_WB_m = {4, 0, 0}});
  World world(rough_world(1), robot::legion(), starts);
  const ActuatorFrame frame = hover_frame(LatchCommand::engage);
  testing::AllocationGuard guard;
  for (int k = 0; k < 100; ++k) {
    for (const std::uint32_t id : {1U, 2U}) world.actuate(id, frame);
    world.advance(world.now() + 2ms);
    (void)world.sense(1);
    (void)world.truth_contact(1, 0);
  }
  EXPECT_EQ(guard.framework(), 0U) << guard.describe();
  EXPECT_EQ(world.latched_links(), 1);
}

}  // namespace
}  // namespace eciton::hal::sim
