// Readings to the ring: each once, at its own rate, and nothing that was not read.
#include "hal/host/sense_service.hpp"

#include "tests/hal/host/fake_buses.hpp"
#include "tests/hal/host/host_bench.hpp"

namespace eciton::hal {
namespace {

/// The ring's other side.
struct Ears {
  explicit Ears(HostBench& bench)
      : imu(bench.services.create_reader(topics::imu)),
        pose(bench.services.create_reader(topics::pose_measurement)),
        rotors(bench.services.create_reader(topics::rotor_state)),
        joints(bench.services.create_reader(topics::joint_state)),
        latches(bench.services.create_reader(topics::latch_state)) {}
  bus::Reader<msg::Imu> imu;
  bus::Reader<msg::PoseMeasurement> pose;
  bus::Reader<msg::RotorState> rotors;
  bus::Reader<msg::JointState> joints;
  bus::Reader<msg::LatchState> latches;
};

TEST(SenseServiceTest, PublishesEveryImuSampleOnceWithItsOwnStamp) {
  HostBench bench;
  Ears ears(bench);
  bench.readings.imu.w_WM_M_rad_s = {0.1, 0.2, 0.3};
  for (int k = 0; k < 20; ++k) {
    bench.tick();
    EXPECT_TRUE(bench.sense.imu_sampled());
    const auto imu = ears.imu.take();
    ASSERT_TRUE(imu.has_value());
    EXPECT_EQ(imu->value.module_id, bench_id);
    EXPECT_EQ(imu->value.stamp_ns, to_ns(bench.readings.imu.stamp));
    EXPECT_EQ(imu->value.w_WM_M_rad_s, (std::array<double, 3>{0.1, 0.2, 0.3}));
    EXPECT_EQ(imu->value.specific_force_M_m_s2[2], robot::gravity_m_s2);
  }
  // The same sample again is no news.
  bench.sense.step(bench.now);
  EXPECT_FALSE(bench.sense.imu_sampled());
}

TEST(SenseServiceTest, PublishesAPoseWhenItArrivesStampedWhenItWasMeasured) {
  HostBench bench;
  Ears ears(bench);
  bench.tick();
  EXPECT_FALSE(ears.pose.take().has_value()) << "none came yet";
  bench.readings.pose_count = 1;
  bench.readings.pose = {
      .stamp = bench.now - 30ms, .source = PoseSourceKind::lio, .p_WB_m = {1, 2, 3}, .position_std_m = 0.01};
  bench.tick();
  const auto pose = ears.pose.take();
  ASSERT_TRUE(pose.has_value());
  EXPECT_EQ(pose->value.stamp_ns, to_ns(bench.readings.pose.stamp));
  EXPECT_EQ(pose->value.source, msg::PoseSourceKind::lio);
  EXPECT_EQ(pose->value.p_WB_m, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(pose->value.position_std_m, 0.01);
  bench.tick_for(100ms);
  EXPECT_FALSE(ears.pose.take().has_value()) << "each once";
}

TEST(SenseServiceTest, PublishesActuatorsAtAHundredHertzAndSaysWhetherTheyAreArmed) {
  HostBench bench;
  Ears ears(bench);
  bench.readings.rotors[1] = {.thrust_N = 7, .gimbal_rad = {0.1, 0.2}, .battery_V = 22};
  bench.readings.rotors[0].battery_V = 23;
  bench.readings.joints[1] = {.position_rad = 0.5, .velocity_rad_s = 0.6, .torque_Nm = 0.7};
  int rotors = 0, joints = 0;
  for (int k = 0; k < 500; ++k) {
    bench.send(HostBench::command({5, 5, 5}));
    while (const auto state = ears.rotors.take()) {
      ++rotors;
      ASSERT_EQ(state->value.rotors.size(), 3u);
      EXPECT_EQ(state->value.rotors[1].thrust_N, 7);
      EXPECT_EQ(state->value.rotors[1].gimbal_rad, (std::array<double, 2>{0.1, 0.2}));
      EXPECT_EQ(state->value.battery_V, 23);
      EXPECT_EQ(state->value.armed, rotors > 1) << "the first came before the command was acted on";
    }
    while (const auto state = ears.joints.take()) {
      ++joints;
      ASSERT_EQ(state->value.joints.size(), 2u);
      EXPECT_EQ(state->value.joints[1].position_rad, 0.5);
      EXPECT_EQ(state->value.joints[1].torque_Nm, 0.7);
    }
  }
  EXPECT_EQ(rotors, 100);
  EXPECT_EQ(joints, 100);
}

TEST(SenseServiceTest, TellsOfALatchOnlyWhenItChanges) {
  HostBench bench;
  Ears ears(bench);
  std::vector<std::pair<std::uint32_t, msg::LatchStatus>> heard;
  const auto listen = [&] {
    bench.tick_for(50ms);
    while (const auto state = ears.latches.take()) heard.emplace_back(state->value.port, state->value.status);
    return std::exchange(heard, {});
  };
  EXPECT_EQ(listen().size(), 2u) << "both ports once, as they are";
  EXPECT_TRUE(listen().empty());
  bench.readings.latches[1] = LatchReading::latched;
  const auto changed = listen();
  ASSERT_EQ(changed.size(), 1u);
  EXPECT_EQ(changed[0].first, 1u);
  EXPECT_EQ(changed[0].second, msg::LatchStatus::latched);
}

TEST(SenseServiceTest, PublishesNoJointsThatWereNotRead) {
  HostBench bench;
  Ears ears(bench);
  auto owned = std::make_unique<FlakyJointBus>();
  FlakyJointBus& bus = *owned;
  bench.devices.joints = std::move(owned);
  bus.broken = true;
  bench.tick_for(200ms);
  EXPECT_FALSE(ears.joints.take().has_value());
  EXPECT_TRUE(ears.rotors.take().has_value()) << "the others go on";
  EXPECT_EQ(bus.reads, 20) << "once a slow period";
  EXPECT_EQ(bus.errors, bus.reads);
  bus.broken = false;
  bench.tick_for(20ms);
  EXPECT_TRUE(ears.joints.take().has_value());
}

// Unconfigured devices cannot be read: nothing comes of them. Configured ones, inactive, can.
TEST(SenseServiceTest, IsSilentWithoutConfiguredDevices) {
  HostBench bench;
  Ears ears(bench);
  bench.devices = sim::make_devices(bench.board, bench.airframe);
  bench.readings.pose_count = 1;
  bench.readings.pose.stamp = bench.now;
  bench.tick_for(100ms);
  EXPECT_FALSE(ears.imu.take().has_value());
  EXPECT_FALSE(ears.pose.take().has_value());
  EXPECT_FALSE(ears.rotors.take().has_value());
  EXPECT_FALSE(ears.joints.take().has_value());
  EXPECT_FALSE(ears.latches.take().has_value());
  bench.devices.for_each([](Device& device) { ok_or_throw(device.configure()); });
  bench.tick_for(20ms);
  EXPECT_TRUE(ears.imu.take().has_value());
  EXPECT_TRUE(ears.pose.take().has_value());
  EXPECT_TRUE(ears.rotors.take().has_value());
  EXPECT_TRUE(ears.joints.take().has_value());
  EXPECT_TRUE(ears.latches.take().has_value());
}

}  // namespace
}  // namespace eciton::hal
