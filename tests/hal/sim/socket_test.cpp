// The world's server and its hosts over real sockets: lockstep, wall clock, and what goes wrong with either.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "hal/sim/socket_link.hpp"
#include "hal/sim/world_server.hpp"
#include "tests/hal/sim/worlds.hpp"

namespace eciton::hal::sim {
namespace {

/// A path of this test's own, short enough for a socket.
std::string socket_path() {
  static int count = 0;
  return (std::filesystem::temp_directory_path() /
          ("eciton_sim_" + std::to_string(::getpid()) + "_" + std::to_string(count++)))
      .string();
}

std::vector<ModuleStart> two_modules() {
  return {{.id = 1, .p_WB_m = {0, 0, 2}, .hovering = true}, {.id = 2, .p_WB_m = {2, 0, 2}, .hovering = true}};
}

/// Answers every tick with hover thrust until the world says goodbye, or after `ticks` answers.
void host(const std::string& path, std::uint32_t module, std::uint64_t ticks = UINT64_MAX,
          std::string* end_reason = nullptr) {
  auto link = SocketLink::connect(path, module);
  ASSERT_TRUE(link) << link.error().message;
  for (std::uint64_t k = 0; k < ticks;) {
    const Io io = (*link)->wait_sensors(5s);
    if (io == Io::error) break;
    if (io == Io::timeout) continue;
    EXPECT_EQ((*link)->board().sensors().module_id, module);
    (*link)->board().actuators() = hover_frame(LatchCommand::hold);
    if ((*link)->act() != Io::ok) break;
    ++k;
  }
  if (end_reason != nullptr) *end_reason = (*link)->end_reason();
}

TEST(LockstepTest, RunsAsTheSameWorldDoesInOneProcess) {
  World direct(WorldConfig{}, robot::legion(), two_modules());
  for (int k = 0; k < 250; ++k) {
    for (const std::uint32_t id : {1U, 2U}) direct.actuate(id, hover_frame(LatchCommand::hold));
    direct.advance(direct.now() + 2ms);
  }
  World world(WorldConfig{}, robot::legion(), two_modules());
  const std::string path = socket_path();
  std::string reason;
  std::vector<TimePoint> observed;
  {
    WorldServer server(world, {.path = path});
    server.set_observer([&](const World& w, TimePoint now) {
      EXPECT_EQ(w.now(), now);
      observed.push_back(now);
    });
    ASSERT_TRUE(server.open());
    std::thread first(host, path, 1, UINT64_MAX, &reason), second(host, path, 2, UINT64_MAX, nullptr);
    const Status half = server.run(at_ms(200));
    const Status run = server.run(at_ms(500));  // goes on where it was
    server.close("enough");
    first.join();
    second.join();
    ASSERT_TRUE(half && run);
    EXPECT_EQ(server.stats().ticks, 250U);
  }
  EXPECT_EQ(observed.size(), 250U);
  EXPECT_EQ(world.now(), at_ms(500));
  EXPECT_EQ(reason, "enough");
  EXPECT_FALSE(std::filesystem::exists(path));
  for (const std::uint32_t id : {1U, 2U}) {
    EXPECT_EQ(world.truth_pose(id).X_WB.p, direct.truth_pose(id).X_WB.p);
    EXPECT_EQ(world.sense(id).imu.specific_force_M_m_s2, direct.sense(id).imu.specific_force_M_m_s2);
  }
}

TEST(LockstepTest, StallNamesTheModuleThatDidNotAnswer) {
  World world(WorldConfig{}, robot::legion(), two_modules());
  const std::string path = socket_path();
  WorldServer server(world, {.path = path, .stall_timeout = 1s});
  ASSERT_TRUE(server.open());
  std::string reason;
  std::thread good(host, path, 1, UINT64_MAX, &reason);
  auto silent = std::thread([&] {
    auto link = SocketLink::connect(path, 2);
    ASSERT_TRUE(link);
    for (int k = 0; k < 10; ++k) {
      if ((*link)->wait_sensors(5s) == Io::ok) (void)(*link)->act();
    }
    while ((*link)->wait_sensors(5s) != Io::error) {  // hears, and says nothing
    }
  });
  const Status run = server.run(at_ms(10'000));
  good.join();
  silent.join();
  ASSERT_FALSE(run);
  EXPECT_NE(run.error().message.find("from module 2"), std::string::npos) << run.error().message;
  EXPECT_EQ(run.error().message.find("module 1"), std::string::npos) << run.error().message;
  EXPECT_NE(run.error().message.find("at tick 11"), std::string::npos) << run.error().message;
  EXPECT_EQ(reason, run.error().message);  // the others are told
}

TEST(LockstepTest, HostThatDiesIsNamedAtOnce) {
  World world(WorldConfig{}, robot::legion(), two_modules());
  const std::string path = socket_path();
  WorldServer server(world, {.path = path});
  ASSERT_TRUE(server.open());
  std::thread good(host, path, 1, UINT64_MAX, nullptr), mortal(host, path, 2, 20, nullptr);
  const Status run = server.run(at_ms(10'000));
  good.join();
  mortal.join();
  ASSERT_FALSE(run);
  EXPECT_NE(run.error().message.find("lost a hardware host"), std::string::npos) << run.error().message;
  // Its goodbye, or, when the server writes into the closed socket before it reads that, the closing itself.
  const std::string& message = run.error().message;
  EXPECT_TRUE(message.find("module 2 (the host ends)") != std::string::npos ||
              message.find("module 2 (its host closed the connection)") != std::string::npos)
      << message;
}

TEST(LockstepTest, NamesTheModulesWhoseHostsNeverCame) {
  World world(WorldConfig{}, robot::legion(), two_modules());
  const std::string path = socket_path();
  WorldServer server(world, {.path = path, .join_timeout = 2s});
  ASSERT_TRUE(server.open());
  std::thread good(host, path, 2, UINT64_MAX, nullptr);
  const Status run = server.run(at_ms(10'000));
  good.join();
  ASSERT_FALSE(run);
  EXPECT_NE(run.error().message.find("for module 1;"), std::string::npos) << run.error().message;
}

TEST(LockstepTest, CanBeStoppedFromAnotherThread) {
  World world(WorldConfig{}, robot::legion(), two_modules());
  const std::string path = socket_path();
  WorldServer server(world, {.path = path});
  ASSERT_TRUE(server.open());
  std::thread stopper([&] {
    std::this_thread::sleep_for(50ms);
    server.stop();
  });
  EXPECT_TRUE(server.run(at_ms(10'000)));  // although no host ever came
  stopper.join();
}

TEST(WorldServerTest, RefusesASecondHostAnUnknownModuleAndAStrangeVersion) {
  World world(WorldConfig{}, robot::legion(), two_modules());
  const std::string path = socket_path();
  WorldServer server(world, {.path = path});
  ASSERT_TRUE(server.open());
  Status run = ok();
  std::thread serving([&] { run = server.run(at_ms(1'000'000)); });
  auto first = SocketLink::connect(path, 1);
  ASSERT_TRUE(first) << first.error().message;
  auto second = SocketLink::connect(path, 1);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("module 1 already has a hardware host"), std::string::npos)
      << second.error().message;
  auto unknown = SocketLink::connect(path, 7);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("no module 7 in this world; it has 1, 2"), std::string::npos);
  auto raw = connect_to(path);
  ASSERT_TRUE(raw);
  ASSERT_TRUE(raw->send(Hello{.version = 99, .module_id = 2}));
  ASSERT_TRUE(raw->wait(5s));
  const auto answer = raw->receive();
  ASSERT_EQ(answer.type, MessageType::refused);
  EXPECT_NE(std::string(raw->as<Refused>(answer)->reason.view()).find("version 99"), std::string::npos);
  server.stop();
  serving.join();
  EXPECT_TRUE(run);
}

TEST(WorldServerTest, SaysWhyItCannotOpen) {
  World world(WorldConfig{}, robot::legion(), two_modules());
  const std::string path = socket_path();
  WorldServer server(world, {.path = path});
  ASSERT_TRUE(server.open());
  WorldServer other(world, {.path = path});
  EXPECT_NE(other.open().error().message.find("in use by another world"), std::string::npos);
  server.close("");
  { std::ofstream(path) << "left over"; }
  EXPECT_NE(WorldServer(world, {.path = path}).open().error().message.find("already exists"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(path));  // not ours to remove
  std::filesystem::remove(path);
  EXPECT_NE(WorldServer(world, {.path = std::string(200, 'x')}).open().error().message.find("200 characters"),
            std::string::npos);
  EXPECT_NE(WorldServer(world, {.path = path, .modules = {5}}).open().error().message.find("module 5"),
            std::string::npos);
  EXPECT_FALSE(SocketLink::connect(path, 1, 50ms));
}

TEST(WallClockTest, FliesOnCutsTheModuleOfADeadHostAndTakesItsSuccessor) {
  World world(still_world(), robot::legion(), two_modules());
  const std::string path = socket_path();
  WorldServer server(world, {.path = path, .pace = Pace::wall});
  std::atomic<int> phase{0};
  server.set_observer([&](const World& w, TimePoint) {
    const double thrust_N = w.sense(2).rotors[0].thrust_N;
    if (phase == 1 && thrust_N < 1) phase = 2;   // cut: its motors have run down
    if (phase == 3 && thrust_N > 12) phase = 4;  // a new host has taken over
  });
  ASSERT_TRUE(server.open());
  Status run = ok();
  std::thread serving([&] { run = server.run(at_ms(30'000)); });
  const auto reached = [&](int goal) {
    for (int k = 0; k < 1000 && phase < goal; ++k) std::this_thread::sleep_for(10ms);
    return phase >= goal;
  };
  std::thread good(host, path, 1, UINT64_MAX, nullptr);
  host(path, 2, 30);  // ... and dies
  phase = 1;
  EXPECT_TRUE(reached(2));
  phase = 3;
  std::thread successor(host, path, 2, UINT64_MAX, nullptr);
  EXPECT_TRUE(reached(4));
  server.stop();
  serving.join();
  server.close("enough");
  good.join();
  successor.join();
  EXPECT_TRUE(run);
  EXPECT_GE(server.stats().cuts, 1U);
  EXPECT_LT(world.truth_pose(2).X_WB.p.z(), world.truth_pose(1).X_WB.p.z());
}

TEST(WallClockTest, KeepsTheTimeOfTheWallAndWaitsForNobody) {
  World world(still_world(), robot::legion(), two_modules());
  const std::string path = socket_path();
  WorldServer server(world, {.path = path, .pace = Pace::wall});
  ASSERT_TRUE(server.open());
  auto deaf = std::thread([&] {
    auto link = SocketLink::connect(path, 1);
    ASSERT_TRUE(link);
    if ((*link)->wait_sensors(5s) == Io::ok) (void)(*link)->act();
    std::this_thread::sleep_for(300ms);  // its buffer fills up
  });
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(server.run(at_ms(400)));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 398ms);
  EXPECT_EQ(world.now(), at_ms(400));
  EXPECT_EQ(server.stats().ticks + server.stats().missed_ticks, 200U);
  EXPECT_GT(server.stats().late_answers, 0U);
  server.close("");
  deaf.join();
}

}  // namespace
}  // namespace eciton::hal::sim
