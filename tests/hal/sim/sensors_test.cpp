// Noise, bias, drift, rate and latency of the simulated sensors, and that the statistics tests can fail.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hal/sim/sensors.hpp"
#include "tests/hal/sim/worlds.hpp"

namespace eciton::hal::sim {
namespace {

using robot::Vector3;

Random stream(Purpose purpose, std::uint64_t seed = 7) { return {seed, 1, purpose}; }

/// Mean and standard deviation of what it is given.
struct Statistics {
  void add(double x) { ++n, sum += x, sum_squares += x * x; }
  double mean() const { return sum / n; }
  double deviation() const { return std::sqrt(sum_squares / n - mean() * mean()); }
  double n = 0, sum = 0, sum_squares = 0;
};

Vector3 vector(const std::array<double, 3>& a) { return Vector3(a.data()); }
robot::Matrix3 rotation(const std::array<double, 4>& q) {
  return robot::Quaternion(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

TEST(RandomTest, IsUniformAndNormalAndDiffersByStream) {
  Random a = stream(Purpose::imu), b = stream(Purpose::pose);
  Statistics uniform, normal, product;
  for (int k = 0; k < 200'000; ++k) {
    uniform.add(a.uniform());
    const double x = a.normal();
    normal.add(x);
    product.add(x * b.normal());
  }
  EXPECT_NEAR(uniform.mean(), 0.5, 0.003);
  EXPECT_NEAR(uniform.deviation(), std::sqrt(1.0 / 12), 0.002);
  EXPECT_NEAR(normal.mean(), 0, 0.01);
  EXPECT_NEAR(normal.deviation(), 1, 0.01);
  EXPECT_NEAR(product.mean(), 0, 0.01);  // two streams know nothing of each other
}

/// An IMU at rest at `f`, turning at `w`, for 20 s.
std::array<Statistics, 6> imu_statistics(const ImuConfig& config, const Vector3& f, const Vector3& w) {
  ImuSensor imu(config, 1, stream(Purpose::imu), stream(Purpose::imu_fault));
  std::array<Statistics, 6> out;
  TimePoint last = TimePoint::min();
  for (int ms = 0; ms < 20'000; ++ms) {
    imu.step(at_ms(ms), f, w);
    if (imu.reading().stamp == last) continue;
    last = imu.reading().stamp;
    for (std::size_t k = 0; k < 3; ++k) {
      out[k].add(imu.reading().specific_force_M_m_s2[k]);
      out[3 + k].add(imu.reading().w_WM_M_rad_s[k]);
    }
  }
  return out;
}

TEST(ImuSensorTest, HasTheNoiseAndRateThatItsConfigSays) {
  const ImuConfig config;
  const auto statistics = imu_statistics(config, {1, 2, 9.81}, {0.1, -0.2, 0.3});
  const std::array<double, 6> truth{1, 2, 9.81, 0.1, -0.2, 0.3};
  for (std::size_t k = 0; k < 6; ++k) {
    const double noise = k < 3 ? config.accelerometer_noise_m_s2 : config.gyroscope_noise_rad_s;
    const double bias = k < 3 ? config.accelerometer_bias_m_s2 : config.gyroscope_bias_rad_s;
    EXPECT_EQ(statistics[k].n, 10'000);
    EXPECT_NEAR(statistics[k].deviation(), noise, 0.03 * noise);
    EXPECT_LT(std::abs(statistics[k].mean() - truth[k]), 4 * bias);
  }
  // There is a bias: 10,000 samples of noise alone would average to a hundredth of their deviation.
  EXPECT_GT(std::abs(statistics[0].mean() - truth[0]) + std::abs(statistics[1].mean() - truth[1]),
            8 * config.accelerometer_noise_m_s2 / 100);
  // Negative control: the same check must not accept noise half as large.
  ImuConfig quieter = config;
  quieter.accelerometer_noise_m_s2 /= 2;
  EXPECT_GT(
      std::abs(imu_statistics(quieter, {1, 2, 9.81}, {0, 0, 0})[0].deviation() - config.accelerometer_noise_m_s2),
      0.03 * config.accelerometer_noise_m_s2);
}

TEST(ImuSensorTest, AveragesTheForceOverItsPeriod) {
  ImuConfig config;
  config.rate_Hz = 200;
  ImuSensor imu(config, 0, stream(Purpose::imu), stream(Purpose::imu_fault));
  for (int ms = 0; ms <= 10; ++ms) imu.step(at_ms(ms), Vector3(ms, 0, 0), Vector3(0, ms, 0));
  EXPECT_EQ(to_ns(imu.reading().stamp), 10'000'000);
  EXPECT_DOUBLE_EQ(imu.reading().specific_force_M_m_s2[0], (6 + 7 + 8 + 9 + 10) / 5.0);
  EXPECT_DOUBLE_EQ(imu.reading().w_WM_M_rad_s[1], 10);
}

TEST(PoseSensorTest, HandsOverEachMeasurementAfterItsLatency) {
  PoseSensorConfig config;  // 100 Hz, 10 ms
  config.latency_s = 0.025;
  PoseSensor sensor(config, PoseSourceKind::mocap, 0, Vector3::Zero(), stream(Purpose::pose), stream(Purpose::drift),
                    stream(Purpose::pose_fault));
  for (int ms = 0; ms <= 200; ++ms) {
    const double x = 0.001 * ms;  // so that the position tells when it was measured
    sensor.step(at_ms(ms), {Vector3(x, 0, 0), robot::Matrix3::Identity()});
    EXPECT_EQ(sensor.has_reading(), ms >= 25);
    if (!sensor.has_reading()) continue;
    const int measured_ms = (ms - 25) / 10 * 10;
    EXPECT_EQ(to_ns(sensor.reading().stamp), measured_ms * 1'000'000) << ms;
    EXPECT_NEAR(sensor.reading().p_WB_m[0], 0.001 * measured_ms, 1e-12);
  }
}

TEST(PoseSensorTest, HasTheNoiseBiasAndAttitudeBiasThatItIsGiven) {
  PoseSensorConfig config;
  const Vector3 attitude_bias(0.006, -0.004, 0.002);
  PoseSensor sensor(config, PoseSourceKind::mocap, 1, attitude_bias, stream(Purpose::pose), stream(Purpose::drift),
                    stream(Purpose::pose_fault));
  const robot::Pose truth{{1, 2, 3}, robot::exp_so3({0.2, -0.1, 1.5})};
  std::array<Statistics, 6> error;
  for (int ms = 0; ms < 100'000; ++ms) {
    sensor.step(at_ms(ms), truth);
    if (ms % 10 != 0 || !sensor.has_reading()) continue;
    const Vector3 position = vector(sensor.reading().p_WB_m) - truth.p;
    const Vector3 attitude = robot::log_so3(truth.R.transpose() * rotation(sensor.reading().q_WB));
    for (int k = 0; k < 3; ++k) {
      error[static_cast<std::size_t>(k)].add(position[k]);
      error[static_cast<std::size_t>(3 + k)].add(attitude[k]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(error[k].deviation(), config.position_noise_m, 0.03 * config.position_noise_m);
    EXPECT_LT(std::abs(error[k].mean()), 4 * config.position_bias_m);
    EXPECT_NEAR(error[3 + k].deviation(), config.attitude_noise_rad, 0.03 * config.attitude_noise_rad);
    EXPECT_NEAR(error[3 + k].mean(), attitude_bias[static_cast<int>(k)], 3e-4);
  }
}

TEST(PoseSensorTest, LioDriftsSlowlyAndStaysWithinItsBound) {
  const PoseSensorConfig config = lio_defaults();
  Statistics drift, change;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    PoseSensorConfig quiet = config;
    quiet.position_noise_m = 0;
    PoseSensor sensor(quiet, PoseSourceKind::lio, 1, Vector3::Zero(), stream(Purpose::pose, seed),
                      stream(Purpose::drift, seed), stream(Purpose::pose_fault, seed));
    Vector3 before = Vector3::Zero();
    for (int ms = 0; ms < 60'000; ++ms) {
      sensor.step(at_ms(ms), {});
      if (ms % 1000 != 100) continue;
      const Vector3 now = vector(sensor.reading().p_WB_m);
      EXPECT_LE(now.norm(), 0.028 + 1e-12);
      drift.add(now.x());
      if (ms > 100) change.add(now.x() - before.x());
      before = now;
    }
  }
  EXPECT_NEAR(drift.deviation(), 0.01, 0.001);
  // In 1 s of a 10 s process: sigma sqrt(2 (1 - exp(-0.1))).
  EXPECT_NEAR(change.deviation(), 0.01 * std::sqrt(2 * (1 - std::exp(-0.1))), 0.0005);
}

TEST(WorldSensorTest, ReadingsAreTheTruthWhenNothingDisturbsThem) {
  World world(still_world(), robot::legion(), {{.id = 1, .p_WB_m = {1, 2, 3}, .yaw_rad = 0.5}});
  world.advance(at_ms(102));
  const SensorFrame frame = world.sense(1);
  EXPECT_GT(frame.pose_count, 0U);
  EXPECT_EQ(to_ns(frame.pose.stamp), 90'000'000);
  EXPECT_NEAR(frame.pose.p_WB_m[2], 3 - 9.81 * 0.09 * 0.091 / 2, 1e-6);
  EXPECT_LT(robot::log_so3(rotation(frame.pose.q_WB) * robot::exp_so3({0, 0, -0.5})).norm(), 1e-3);
  EXPECT_EQ(to_ns(frame.imu.stamp), 102'000'000);
  EXPECT_LT(vector(frame.imu.specific_force_M_m_s2).norm(), 1e-2);  // falling: nothing pulls
  EXPECT_EQ(frame.rotor_count, 3U);
  EXPECT_EQ(frame.joint_count, 2U);
  EXPECT_EQ(frame.port_count, 2U);
  EXPECT_EQ(frame.rotors[0].battery_V, 24.2);
}

TEST(WorldSensorTest, ImuSeesTheMotionThatThePhysicsMakes) {
  // Integrating the noise-free IMU from the true start must lead to the true end: a spinning, tilting throw.
  World world(still_world(), robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 20}, .hovering = true}});
  ActuatorFrame frame = hover_frame(LatchCommand::hold);
  set_thrust(frame, 0, frame.rotors[0].thrust_N + 2);
  frame.rotors[1].gimbal_rad = {0.3, -0.2};
  world.actuate(1, frame);
  TruthPose x = world.truth_pose(1);
  Vector3 v = x.v_WB_m_s, w_before = x.w_WM_M_rad_s;
  robot::Pose X = x.X_WB;
  const double dt = 2e-3;
  for (int k = 0; k < 250; ++k) {
    world.advance(world.now() + 2ms);
    const ImuReading imu = world.sense(1).imu;
    const Vector3 w = vector(imu.w_WM_M_rad_s), half = 0.25 * dt * (w_before + w);
    const Vector3 a = X.R * robot::exp_so3(half) * vector(imu.specific_force_M_m_s2) - Vector3(0, 0, 9.81);
    X.p += dt * v + 0.5 * dt * dt * a;
    v += dt * a;
    X.R = X.R * robot::exp_so3(2 * half);
    w_before = w;
  }
  x = world.truth_pose(1);
  EXPECT_GT(x.w_WM_M_rad_s.norm(), 2);
  EXPECT_GT(robot::log_so3(x.X_WB.R).norm(), 0.5);
  EXPECT_LT((v - x.v_WB_m_s).norm(), 0.01);
  EXPECT_LT((X.p - x.X_WB.p).norm(), 0.005);
  EXPECT_LT(robot::log_so3(X.R.transpose() * x.X_WB.R).norm(), 0.005);
}

}  // namespace
}  // namespace eciton::hal::sim
