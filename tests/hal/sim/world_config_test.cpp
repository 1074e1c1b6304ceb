// The world's configuration as its users write it.
#include "hal/sim/world_config.hpp"

#include <gtest/gtest.h>

namespace eciton::hal::sim {
namespace {

Status read(const std::string& yaml, WorldConfig& config) {
  ConfigTree tree;
  if (Status parsed = tree.add_text(yaml, "test"); !parsed) return parsed;
  return read_config(tree, config);
}

TEST(WorldConfigTest, IsHonestByDefaultAndReadsItsKeys) {
  WorldConfig config;
  EXPECT_EQ(config.world, "honest");
  EXPECT_TRUE(config.wakes);
  const Status status = read(
      "seed: 9\nsensing: lio\ngust_N: 2\nwind_N: [0, 4, 0]\nimu: {rate_Hz: 200}\nlio: {latency_s: 0.1}\n"
      "break: weld-off\nmodules:\n  - {id: 1, position_m: [0, 0, 1.5], hovering: true}\n  - {id: 2, yaw_rad: 0.5}\n",
      config);
  ASSERT_TRUE(status) << status.error().message;
  EXPECT_EQ(config.seed, 9U);
  EXPECT_EQ(config.pose_sensor().latency_s, 0.1);
  EXPECT_EQ(config.pose_sensor().rate_Hz, 20);  // lio's own default stays
  EXPECT_EQ(config.imu.rate_Hz, 200);
  EXPECT_EQ(config.wind_N[1], 4);
  EXPECT_EQ(config.break_what, "weld-off");
  ASSERT_EQ(config.modules.size(), 2U);
  EXPECT_EQ(config.modules[0].p_WB_m[2], 1.5);
  EXPECT_TRUE(config.modules[0].hovering);
  EXPECT_EQ(config.modules[1].yaw_rad, 0.5);
}

TEST(WorldConfigTest, RefusesWhatIsNoWorld) {
  for (const char* yaml : {"world: perfect", "sensing: gps", "gust_N: -1", "break: everything", "wake: true"}) {
    WorldConfig config;
    EXPECT_FALSE(read(yaml, config)) << yaml;
  }
}

}  // namespace
}  // namespace eciton::hal::sim
