// A tap between a real served world and a real link: nothing changes but that it is seen.
#include "benchmarks/path/link_tap.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <thread>

#include "core/base/wall_clock.hpp"
#include "core/robot/airframe.hpp"
#include "hal/sim/socket_link.hpp"
#include "hal/sim/world_server.hpp"

namespace eciton::bench {
namespace {

std::string socket_path(const char* name) { return testing::TempDir() + name + std::to_string(::getpid()); }

TEST(LinkTapTest, PassesReadingsAndCommandsOnAndNotesWhenTheyPassed) {
  const std::string world_path = socket_path("tap-world"), host_path = socket_path("tap-host");
  hal::sim::WorldConfig config;
  config.modules = {{.id = 3}};
  hal::sim::World world(config, robot::legion(false), config.modules);
  hal::sim::WorldServer server(world, {.path = world_path});
  ASSERT_TRUE(server.open());
  std::thread serving([&] { static_cast<void>(server.run(TimePoint::max())); });

  runtime::StopFlag stop;
  std::uint64_t hooks = 0;
  LinkTap tap({.host_path = host_path, .world_path = world_path, .ticks_max = 100}, [&] { ++hooks; });
  ASSERT_TRUE(tap.open());
  tap.record(true);
  std::thread tapping([&] { tap.run(stop); });

  std::uint64_t answered = 0;
  {
    const auto link = hal::sim::SocketLink::connect(host_path, 3);
    ASSERT_TRUE(link) << link.error().message;
    EXPECT_EQ((*link)->pace(), hal::sim::Pace::lockstep);
    for (; answered < 20; ++answered) {
      ASSERT_EQ((*link)->wait_sensors(std::chrono::seconds(10)), hal::Io::ok);
      (*link)->board().actuators().rotors[1].thrust_N = static_cast<double>(answered);
      ASSERT_EQ((*link)->act(), hal::Io::ok);
    }
    // In lockstep the next readings come only when the last answer has arrived.
    ASSERT_EQ((*link)->wait_sensors(std::chrono::seconds(10)), hal::Io::ok);
  }
  stop.request();
  tapping.join();
  server.stop();
  serving.join();

  ASSERT_GE(tap.ticks().size(), answered);
  for (std::size_t k = 0; k < answered; ++k) {
    const LinkTick& tick = tap.ticks()[k];
    EXPECT_GE(tick.in_ns, tick.out_ns) << k;
    std::array<RotorPrint, hal::sim::max_rotors> rotors{};
    rotors[1].thrust_N = static_cast<double>(k);
    EXPECT_EQ(tick.command, command_print(rotors)) << k;
  }
  EXPECT_GE(hooks, 2 * answered);
}

}  // namespace
}  // namespace eciton::bench
