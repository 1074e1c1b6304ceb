// The simulated devices on a board: their lifecycle, and what their commands and readings become.
#include <gtest/gtest.h>

#include "hal/sim/devices.hpp"
#include "hal/sim/direct_link.hpp"
#include "tests/hal/sim/worlds.hpp"

namespace eciton::hal::sim {
namespace {

TEST(DevicesTest, NothingWorksBeforeItIsConfiguredAndNothingActsBeforeItIsActive) {
  Board board;
  SimRotorBus rotors(board, 3, robot::thrust_map(robot::legion()));
  SimJointBus joints(board, 2);
  SimLatch latch(board, 0);
  SimImu imu(board);
  std::array<RotorSetpoint, 3> thrust{};
  std::array<RotorReading, 3> rotor_readings{};
  ImuReading imu_reading;
  LatchReading latch_reading{};
  EXPECT_FALSE(rotors.activate());
  EXPECT_NE(joints.activate().error().message.find("before it was configured"), std::string::npos);
  EXPECT_EQ(rotors.read(rotor_readings), Io::error);
  EXPECT_EQ(imu.read(imu_reading), Io::error);
  EXPECT_EQ(latch.read(latch_reading), Io::error);
  ASSERT_TRUE(rotors.configure());
  ASSERT_TRUE(latch.configure());
  EXPECT_EQ(rotors.write(thrust), Io::error);
  EXPECT_EQ(latch.write(true), Io::error);
  EXPECT_EQ(rotors.read(rotor_readings), Io::nothing_new);
  ASSERT_TRUE(rotors.activate());
  EXPECT_EQ(rotors.write(thrust), Io::ok);
  EXPECT_EQ(rotors.write(std::span(thrust).first(2)), Io::error);  // one setpoint per rotor
}

TEST(DevicesTest, RefuseMoreThanAFrameHolds) {
  Board board;
  SimRotorBus rotors(board, 9, robot::thrust_map(robot::legion()));
  SimLatch latch(board, 4);
  EXPECT_NE(rotors.configure().error().message.find("9 of them; a frame holds 8"), std::string::npos);
  EXPECT_FALSE(latch.configure());
}

TEST(DevicesTest, DeactivatedRotorsAreDisarmedAndLatchesHold) {
  Board board;
  SimRotorBus rotors(board, 3, robot::thrust_map(robot::legion()));
  SimJointBus joints(board, 2);
  SimLatch latch(board, 1);
  ASSERT_TRUE(rotors.configure() && joints.configure() && latch.configure());
  ASSERT_TRUE(rotors.activate() && joints.activate() && latch.activate());
  const std::array<RotorSetpoint, 3> thrust{{{.thrust_N = 5}, {.thrust_N = 6}, {.thrust_N = 7}}};
  EXPECT_EQ(rotors.write(thrust), Io::ok);
  EXPECT_EQ(latch.write(true), Io::ok);
  EXPECT_TRUE(board.actuators().armed);
  EXPECT_TRUE(board.actuators().joints_powered);
  EXPECT_EQ(board.actuators().rotors[2].thrust_N, 7);
  EXPECT_EQ(board.actuators().latches[1], LatchCommand::engage);
  rotors.deactivate();
  joints.deactivate();
  latch.deactivate();
  EXPECT_FALSE(board.actuators().armed);
  EXPECT_FALSE(board.actuators().joints_powered);
  EXPECT_EQ(board.actuators().rotors[2].thrust_N, 0);
  EXPECT_EQ(board.actuators().latches[1], LatchCommand::hold);
}

TEST(DevicesTest, JointsHoldWhereTheyAreWhenSwitchedOn) {
  Board board;
  SensorFrame frame;
  frame.joints[0].position_rad = 0.4;
  frame.joints[1].position_rad = -0.2;
  board.set_sensors(frame);
  SimJointBus joints(board, 2);
  ASSERT_TRUE(joints.configure() && joints.activate());
  EXPECT_EQ(board.actuators().joints[0].position_rad, 0.4);
  EXPECT_EQ(board.actuators().joints[1].position_rad, -0.2);
}

TEST(DevicesTest, GiveEachReadingOnce) {
  World world(still_world(), robot::legion(), {{.id = 1}});
  DirectLink link(world, 1);
  SimImu imu(link.board());
  SimPoseSource pose(link.board());
  SimRotorBus rotors(link.board(), 3, robot::thrust_map(robot::legion()));
  ASSERT_TRUE(imu.configure() && pose.configure() && rotors.configure());
  ImuReading imu_reading;
  PoseReading pose_reading;
  std::array<RotorReading, 3> rotor_readings{};
  EXPECT_EQ(imu.read(imu_reading), Io::nothing_new);  // no frame yet
  link.sense();
  EXPECT_EQ(imu.read(imu_reading), Io::ok);
  EXPECT_EQ(imu.read(imu_reading), Io::nothing_new);
  EXPECT_EQ(pose.read(pose_reading), Io::nothing_new);  // still under way
  EXPECT_EQ(rotors.read(rotor_readings), Io::ok);
  EXPECT_EQ(rotors.read(rotor_readings), Io::nothing_new);
  int imu_samples = 0, poses = 0;
  for (int ms = 0; ms < 100; ++ms) {
    world.advance(world.now() + 1ms);
    link.sense();
    imu_samples += imu.read(imu_reading) == Io::ok;
    poses += pose.read(pose_reading) == Io::ok;
  }
  EXPECT_EQ(imu_samples, 50);
  EXPECT_EQ(poses, 10);
  EXPECT_EQ(pose_reading.source, PoseSourceKind::mocap);
}

TEST(DevicesTest, ThrustBecomesAThrottleAtTheVoltageThatIsRead) {
  const robot::ThrustMap map = robot::thrust_map(robot::legion());
  const std::array<RotorSetpoint, 3> thrust{{{.thrust_N = 12}, {.thrust_N = 12}, {.thrust_N = 0}}};
  for (const bool compensates : {true, false}) {
    Board board;
    SensorFrame frame;
    frame.rotors[0].battery_V = 25;
    board.set_sensors(frame);
    SimRotorBus rotors(board, 3, map, compensates);
    ASSERT_TRUE(rotors.configure() && rotors.activate());
    ASSERT_EQ(rotors.write(thrust), Io::ok);
    EXPECT_NEAR(map.thrust_N(board.actuators().throttle_percent[1], 25), 12, 1e-9);
    EXPECT_EQ(board.actuators().throttle_percent[2], map.percent_min);
    frame.rotors[0].battery_V = 22.5;
    board.set_sensors(frame);
    for (int k = 0; k < 1000; ++k) ASSERT_EQ(rotors.write(thrust), Io::ok);
    const double made_N = map.thrust_N(board.actuators().throttle_percent[1], 22.5);
    if (compensates) {
      EXPECT_NEAR(made_N, 12, 1e-3);
    } else {
      EXPECT_LT(made_N, 0.92 * 12);
    }
  }
}

TEST(DirectLinkTest, FliesAModuleThroughItsDevices) {
  World world(still_world(), robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 2}, .hovering = true}});
  DirectLink link(world, 1);
  SimRotorBus rotors(link.board(), 3, robot::thrust_map(robot::legion()));
  SimLatch latch(link.board(), 0);
  link.sense();
  ASSERT_TRUE(rotors.configure() && latch.configure() && rotors.activate() && latch.activate());
  const double hover_N = robot::legion().hover_thrust_N();
  const std::array<RotorSetpoint, 3> thrust{{{.thrust_N = hover_N}, {.thrust_N = hover_N}, {.thrust_N = hover_N}}};
  for (int k = 0; k < 50; ++k) {
    link.sense();
    ASSERT_EQ(rotors.write(thrust), Io::ok);
    ASSERT_EQ(latch.write(true), Io::ok);
    link.act();
    world.advance(world.now() + 2ms);
  }
  EXPECT_NEAR(world.truth_pose(1).X_WB.p.z(), 2, 5e-3);
  link.sense();
  LatchReading reading{};
  EXPECT_EQ(latch.read(reading), Io::ok);
  EXPECT_EQ(reading, LatchReading::ready);
  rotors.deactivate();
  link.act();
  world.advance(world.now() + 300ms);
  EXPECT_LT(world.truth_pose(1).X_WB.p.z(), 1.8);
}

}  // namespace
}  // namespace eciton::hal::sim
