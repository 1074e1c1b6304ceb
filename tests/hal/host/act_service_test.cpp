// Commands to actuators, and what the host does of its own when they stop.
#include "hal/host/act_service.hpp"

#include "tests/hal/host/fake_buses.hpp"
#include "tests/hal/host/host_bench.hpp"

namespace eciton::hal {
namespace {

const std::vector<double> zero{0, 0, 0};
const std::vector<double> uneven{11, 12, 13};

std::size_t count(const std::vector<std::string>& texts, const std::string& part) {
  return static_cast<std::size_t>(
      std::count_if(texts.begin(), texts.end(), [&](const auto& t) { return t.find(part) != std::string::npos; }));
}

TEST(ActServiceTest, MapsCommandsToTheirRotorsAndGimbals) {
  HostBench bench;
  msg::RotorCommand command = HostBench::command(uneven);
  for (std::size_t k = 0; k < 3; ++k) {
    const double angle = 0.1 * static_cast<double>(k + 1);
    command.rotors[k].gimbal_rad = {angle, -2 * angle};
  }
  bench.send(command);
  EXPECT_TRUE(bench.out().armed);
  EXPECT_EQ(bench.thrusts_N(), uneven);
  EXPECT_EQ(bench.out().rotors[0].gimbal_rad, (std::array<double, 2>{0.1, -0.2}));
  EXPECT_EQ(bench.out().rotors[2].gimbal_rad[1], -2 * (0.1 * 3.0));
}

TEST(ActServiceTest, StaysInactiveUntilArmedAndFromDisarmingOn) {
  HostBench bench;
  msg::RotorCommand command = HostBench::command(uneven);
  command.armed = false;
  bench.send(command);
  EXPECT_FALSE(bench.out().armed);
  EXPECT_EQ(bench.thrusts_N(), zero) << "unpowered, whatever the setpoints say";
  EXPECT_TRUE(bench.events.empty());
  command.armed = true;
  bench.send(command);
  EXPECT_TRUE(bench.out().armed);
  EXPECT_EQ(bench.thrusts_N(), uneven);
  command.armed = false;
  bench.send(command);
  EXPECT_FALSE(bench.out().armed);
  EXPECT_EQ(bench.thrusts_N(), zero);
  bench.tick_for(1s);
  EXPECT_FALSE(bench.out().armed) << "silence arms nothing";
  EXPECT_EQ(bench.events,
            (std::vector<std::pair<std::string, std::string>>{{"inactive", "active"}, {"active", "inactive"}}));
  EXPECT_TRUE(bench.faults.empty());
}

TEST(ActServiceTest, IgnoresWhatIsNotForIt) {
  HostBench bench;
  msg::RotorCommand foreign = HostBench::command(uneven);
  foreign.module_id = other_id;
  bench.send(foreign);
  EXPECT_FALSE(bench.out().armed);
  bench.send(HostBench::command({5, 5}));  // one rotor too few
  EXPECT_FALSE(bench.out().armed);
  msg::RotorCommand old = HostBench::command(uneven);
  old.stamp_ns = to_ns(bench.now - 60ms);  // over the topic's lifespan
  bench.rotor_command.write(old);
  bench.tick();
  EXPECT_FALSE(bench.out().armed);
  bench.send(HostBench::command(uneven));  // what differs is only what was wrong above
  EXPECT_TRUE(bench.out().armed);
}

TEST(ActServiceTest, HoldsTheLastOutputForTwentyMilliseconds) {
  HostBench bench;
  bench.send(HostBench::command(uneven));
  for (int k = 0; k < 10; ++k) {
    bench.tick();
    EXPECT_EQ(bench.thrusts_N(), uneven) << (k + 1) * 2 << " ms";
    EXPECT_TRUE(bench.faults.empty());
  }
  bench.tick();
  EXPECT_NE(bench.thrusts_N(), uneven);
  EXPECT_EQ(count(bench.faults, "no rotor command for 20 ms"), 1u);
  bench.tick_for(500ms);
  EXPECT_EQ(count(bench.faults, "no rotor command for 20 ms"), 1u) << "told once";
}

// The negative control of all that follows: while commands come there is no safe output.
TEST(ActServiceTest, ObeysAsLongAsCommandsCome) {
  HostBench bench;
  for (int k = 0; k < 100; ++k) {
    bench.send(HostBench::command(uneven));
    bench.tick_for(14ms);
    EXPECT_EQ(bench.thrusts_N(), uneven);
  }
  EXPECT_TRUE(bench.faults.empty());
}

TEST(ActServiceTest, LevelsATiltedModule) {
  HostBench bench;
  // Rolled by 0.2 rad about x, at rest; the estimator lives and says so.
  const double roll = 0.2;
  bench.readings.imu.specific_force_M_m_s2 = {0, robot::gravity_m_s2 * std::sin(roll),
                                              robot::gravity_m_s2 * std::cos(roll)};
  const auto tell_state = [&] {
    bench.module_state.write(msg::ModuleState{.module_id = bench_id,
                                              .stamp_ns = to_ns(bench.now),
                                              .mode = msg::EstimatorMode::ready,
                                              .q_WM = {std::cos(roll / 2), std::sin(roll / 2), 0, 0}});
  };
  tell_state();
  bench.send(HostBench::command(uneven));
  for (int k = 0; k < 11; ++k) {
    tell_state();
    bench.tick();
  }
  // By hand: the weight upright in world axes is mg (0, sin, cos) in the module's; the moment turns it back by
  // I * 40/s^2 * (-0.2, 0, 0), there being no rate to damp.
  const robot::Wrench wrench_B = bench.wrench_B();
  EXPECT_NEAR(wrench_B.force.x(), 0, 0.05);
  EXPECT_NEAR(wrench_B.force.y(), bench.weight_N() * std::sin(roll), 0.05);
  EXPECT_NEAR(wrench_B.force.z(), bench.weight_N() * std::cos(roll), 0.05);
  EXPECT_NEAR(wrench_B.moment.x(), 0.04178 * -8, 0.005);
  EXPECT_NEAR(wrench_B.moment.y(), 0.00277 * -8, 0.005);
  EXPECT_NEAR(wrench_B.moment.z(), -0.00061 * -8, 0.005);
}

TEST(ActServiceTest, DescendsAndStopsTheMotorsOnTheGround) {
  HostBench bench;
  bench.send(HostBench::command(uneven));
  bench.tick_for(20ms);
  bench.tick();
  // At first it holds its weight ...
  EXPECT_NEAR(bench.wrench_B().force.z(), bench.weight_N(), 0.01 * bench.weight_N());
  EXPECT_NEAR(bench.wrench_B().moment.norm(), 0, 0.01);
  bench.tick_for(1200ms);
  // ... and a second later wants 0.5 m/s downwards: 1 - 2/s * 0.5 m/s / g of it, as long as it does not sink.
  const double share = 1 - 2 * 0.5 / robot::gravity_m_s2;
  EXPECT_NEAR(bench.wrench_B().force.z(), share * bench.weight_N(), 0.005 * bench.weight_N());
  EXPECT_TRUE(bench.out().armed);
  // It never sinks: it stands.
  bench.tick_for(1s);
  EXPECT_FALSE(bench.out().armed);
  EXPECT_EQ(bench.thrusts_N(), zero);
  EXPECT_EQ(bench.events.back(), (std::pair<std::string, std::string>{"active", "inactive"}));
}

TEST(ActServiceTest, HoldsTheHoverWrenchInAChainWhileItsFeedForwardFades) {
  HostBench bench;
  const double fifth_over_N = 1.2 * bench.weight_N() / 3;
  msg::RotorCommand command = HostBench::command({fifth_over_N, fifth_over_N, fifth_over_N});
  command.safe_output = msg::SafeOutput::hold_hover;
  bench.send(command);
  bench.tick_for(20ms);
  bench.tick_for(1s);
  // The fifth over the weight fades with 0.5 s; no descent within two seconds.
  EXPECT_NEAR(bench.wrench_B().force.z(), (1 + 0.2 * std::exp(-2)) * bench.weight_N(), 0.005 * bench.weight_N());
  bench.tick_for(980ms);
  EXPECT_NEAR(bench.wrench_B().force.z(), (1 + 0.2 * std::exp(-4)) * bench.weight_N(), 0.005 * bench.weight_N());
  bench.tick_for(1020ms);
  EXPECT_LT(bench.wrench_B().force.z(), 0.92 * bench.weight_N()) << "then it descends";
  bench.tick_for(1s);
  EXPECT_FALSE(bench.out().armed);
}

TEST(ActServiceTest, ObeysAgainAtOnceWhenCommandsComeBack) {
  HostBench bench;
  bench.send(HostBench::command(uneven));
  bench.tick_for(200ms);
  EXPECT_NE(bench.thrusts_N(), uneven);
  bench.send(HostBench::command(uneven));
  EXPECT_EQ(bench.thrusts_N(), uneven);
  EXPECT_EQ(count(bench.faults, "commands came back"), 1u);
  bench.tick_for(20ms);
  EXPECT_EQ(bench.thrusts_N(), uneven) << "and holds anew";
}

TEST(ActServiceTest, SaysOnceThatTheRotorsRefuseToActivateAndStaysDisarmed) {
  HostBench bench;
  bench.devices.rotors = std::make_unique<DeadRotorBus>();
  bench.send(HostBench::command(uneven));
  bench.send(HostBench::command(uneven));
  EXPECT_EQ(count(bench.faults, "refuses to activate"), 1u);
  EXPECT_FALSE(bench.devices.armed);
  bench.tick_for(100ms);
  EXPECT_EQ(count(bench.faults, "safe output"), 0u) << "there is nothing to fly";
  msg::RotorCommand disarmed = HostBench::command(uneven);
  disarmed.armed = false;
  bench.send(disarmed);
  bench.send(HostBench::command(uneven));
  EXPECT_EQ(count(bench.faults, "refuses to activate"), 2u) << "asked again";
}

TEST(ActServiceTest, MapsCommandsToJointsAndLatches) {
  HostBench bench;
  msg::JointCommand joints{.module_id = bench_id};
  joints.joints.push_back({.position_rad = 0.3, .velocity_rad_s = 0.1});
  joints.joints.push_back({.position_rad = -0.4});
  bench.joint_command.write(joints);
  bench.latch_command.write(msg::LatchCommand{.module_id = bench_id, .port = 1, .engage = true});
  bench.latch_command.write(msg::LatchCommand{.module_id = bench_id, .port = 2, .engage = true});  // there is none
  bench.latch_command.write(msg::LatchCommand{.module_id = other_id, .port = 0, .engage = true});
  bench.tick();
  EXPECT_EQ(bench.out().joints[0].position_rad, 0.3);
  EXPECT_EQ(bench.out().joints[0].velocity_rad_s, 0.1);
  EXPECT_EQ(bench.out().joints[1].position_rad, -0.4);
  EXPECT_EQ(bench.out().latches[0], sim::LatchCommand::hold);
  EXPECT_EQ(bench.out().latches[1], sim::LatchCommand::engage);
  EXPECT_EQ(bench.out().latches[2], sim::LatchCommand::hold);
  bench.latch_command.write(msg::LatchCommand{.module_id = bench_id, .port = 1, .engage = false});
  bench.tick();
  EXPECT_EQ(bench.out().latches[1], sim::LatchCommand::release);
  EXPECT_FALSE(bench.out().armed);
}

TEST(ActServiceTest, ABrokenJointBusDoesNotTouchTheRotors) {
  HostBench bench;
  auto owned = std::make_unique<FlakyJointBus>();
  FlakyJointBus& bus = *owned;
  bench.devices.joints = std::move(owned);
  bus.broken = true;
  msg::JointCommand joints{.module_id = bench_id};
  joints.joints.push_back({.position_rad = 0.3});
  joints.joints.push_back({});
  for (int k = 0; k < 50; ++k) {
    bench.joint_command.write(joints);
    bench.send(HostBench::command(uneven));
    EXPECT_EQ(bench.thrusts_N(), uneven);
  }
  EXPECT_EQ(bus.writes, 50) << "one try a command: retries are the backend's, within its share of the cycle";
  EXPECT_EQ(bus.errors, bus.writes + bus.reads) << "each counted";
  bus.broken = false;
  const int errors = bus.errors;
  bench.joint_command.write(joints);
  bench.send(HostBench::command(uneven));
  EXPECT_EQ(bus.first_rad, 0.3);
  EXPECT_EQ(bus.errors, errors);
}

}  // namespace
}  // namespace eciton::hal
