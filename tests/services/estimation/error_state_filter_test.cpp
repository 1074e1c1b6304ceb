// The state filter on flights known in closed form: consistency of its covariance with negative controls,
// late and lost poses, biases, modes.
#include "services/estimation/error_state_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/services/estimation/simulated_flight.hpp"

namespace eciton::estimation {
namespace {

constexpr int runs = 40;

/// Mean over runs of the normalised estimation error squared, all 15 states: 15 when the filter is honest.
double mean_nees(const FlightConfig& flight_config) {
  ErrorStateFilterConfig config;
  config.accelerometer_bias_std_initial_m_s2 = flight_config.accelerometer_bias_std;
  config.gyroscope_bias_std_initial_rad_s = flight_config.gyroscope_bias_std;
  config.attitude_std_min_rad = config.position_std_min_m = 0;
  config.gate_chi2 = 1e9;  // the gate would hide what is tested here
  double sum = 0;
  for (unsigned seed = 1; seed <= runs; ++seed) {
    SimulatedFlight flight(seed, flight_config, config);
    flight.run_until(5);
    const Eigen::Matrix<double, 15, 1> e = flight.error();
    sum += e.dot(flight.filter.covariance().ldlt().solve(e)) / runs;
  }
  return sum;
}

// 40 x 15 = 600 degrees of freedom: chi^2 / 40 lies within 15 +- 3.3 standard deviations of 0.87, but for one
// seed in a thousand.
constexpr double nees_min = 12.2, nees_max = 17.9;

TEST(ErrorStateFilterTest, CovarianceIsConsistentWithTheErrors) {
  const double nees = mean_nees({});
  EXPECT_GT(nees, nees_min);
  EXPECT_LT(nees, nees_max);
}

TEST(ErrorStateFilterTest, CovarianceIsConsistentWithSlowLatePoses) {
  const double nees = mean_nees({.pose_Hz = 20, .latency_s = 0.06, .position_std_m = 3e-3});
  EXPECT_GT(nees, nees_min);
  EXPECT_LT(nees, nees_max);
}

TEST(ErrorStateFilterTest, NegativeControlAWrongCovarianceIsNoticed) {
  EXPECT_GT(mean_nees({.claimed_share = 0.5}), nees_max);
  EXPECT_LT(mean_nees({.claimed_share = 2.0}), nees_min);
}

TEST(ErrorStateFilterTest, NegativeControlAnIgnoredDelayIsNoticed) {
  EXPECT_GT(mean_nees({.pose_Hz = 20, .latency_s = 0.06, .position_std_m = 3e-3, .stamped_on_arrival = true}),
            3 * nees_max);
}

TEST(ErrorStateFilterTest, CopesWithDriftingLateLidarPosesAndABiasedAttitude) {
  FlightConfig lidar{.pose_Hz = 20, .latency_s = 0.06, .position_std_m = 3e-3};
  lidar.attitude_bias_rad = {0.007, -0.007, 0};
  lidar.drift_std_m = 0.01;
  double position = 0, velocity = 0, attitude = 0;
  int samples = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SimulatedFlight flight(seed, lidar, {});
    flight.run_until(5);
    for (double t = 5; t < 15; t += 0.1, ++samples) {
      flight.run_until(t);
      EXPECT_EQ(flight.filter.estimate().mode, FilterMode::ready);
      const auto e = flight.error();
      position = std::max(position, e.segment<3>(0).norm());
      velocity += e.segment<3>(3).squaredNorm();
      attitude = std::max(attitude, e.segment<3>(6).norm());
    }
    EXPECT_EQ(flight.filter.counters().restarts, 0u);
    EXPECT_EQ(flight.filter.counters().rejected, 0u);
  }
  EXPECT_LT(position, 0.05);  // the drift itself reaches 0.04
  EXPECT_LT(std::sqrt(velocity / samples), 0.03);
  EXPECT_LT(attitude, 0.02);
}

TEST(ErrorStateFilterTest, HoverVelocityNoiseIsSmallEnoughForTheWrenchObserver) {
  double square = 0;
  int samples = 0;
  SimulatedFlight flight(3, {}, {});
  flight.run_until(3);
  for (double t = 3; t < 8; t += 0.01, ++samples) {
    flight.run_until(t);
    square += flight.error().segment<3>(3).squaredNorm() / 3;
  }
  EXPECT_LT(std::sqrt(square / samples), 0.01);
}

TEST(ErrorStateFilterTest, ALatePoseGivesWhatItWouldHaveGivenInTime) {
  // The same poses, one filter gets them at once, the other 40 ms late: after all have come they agree.
  ErrorStateFilter prompt, late;
  std::deque<std::pair<PoseMeasurement, int>> waiting;
  for (int k = 0; k <= 500; ++k) {
    const Truth truth = truth_at(k * 0.002);
    const ImuSample imu{k * 2'000'000, truth.R.transpose() * (truth.a + Vector3(0, 0, 9.81)), truth.w};
    prompt.update(imu);
    late.update(imu);
    if (k % 25 == 0 && k <= 450) {
      const PoseMeasurement m{imu.stamp_ns, {truth.p + Vector3(0.001, 0, 0), truth.R}, 0.002, 0.003};
      prompt.update(m);
      waiting.emplace_back(m, k + 20);
    }
    while (!waiting.empty() && waiting.front().second <= k) {
      late.update(waiting.front().first);
      waiting.pop_front();
    }
  }
  const Estimate a = prompt.estimate(), b = late.estimate();
  EXPECT_LT((a.X_WB.p - b.X_WB.p).norm() + (a.v_WB - b.v_WB).norm() + (a.X_WB.R - b.X_WB.R).norm(), 1e-9);
  EXPECT_LT((prompt.covariance() - late.covariance()).norm(), 1e-9);
}

TEST(ErrorStateFilterTest, PosesOutOfOrderLoseNothing) {
  ErrorStateFilter ordered, swapped;
  std::optional<PoseMeasurement> held;
  for (int k = 0; k <= 200; ++k) {
    const Truth truth = truth_at(k * 0.002);
    const ImuSample imu{k * 2'000'000, truth.R.transpose() * (truth.a + Vector3(0, 0, 9.81)), truth.w};
    ordered.update(imu);
    swapped.update(imu);
    if (k % 10 != 0) continue;
    const PoseMeasurement m{imu.stamp_ns, {truth.p, truth.R}, 0.002, 0.003};
    ordered.update(m);
    if (k == 150) {
      held = m;
      continue;
    }
    EXPECT_NE(swapped.update(m), PoseVerdict::too_old);
    EXPECT_TRUE(k != 160 || swapped.update(*held) == PoseVerdict::fused);
  }
  EXPECT_LT((ordered.estimate().X_WB.p - swapped.estimate().X_WB.p).norm(), 1e-9);
  EXPECT_LT((ordered.covariance() - swapped.covariance()).norm(), 1e-9);
}

TEST(ErrorStateFilterTest, DeadReckonsThenIsLostThenStartsAgain) {
  SimulatedFlight flight(7, {}, {});
  flight.run_until(4);
  EXPECT_EQ(flight.filter.estimate().mode, FilterMode::ready);
  flight.poses_on = false;
  flight.run_until(5);
  EXPECT_EQ(flight.filter.estimate().mode, FilterMode::dead_reckoning);
  EXPECT_NEAR(flight.filter.estimate().pose_age_s, 1, 0.05);
  EXPECT_LT(flight.error().head<3>().norm(), 0.05);
  flight.run_until(5.5);
  flight.poses_on = true;
  flight.run_until(5.6);
  EXPECT_EQ(flight.filter.estimate().mode, FilterMode::ready);
  EXPECT_EQ(flight.filter.counters().restarts, 0u);
  flight.poses_on = false;
  flight.run_until(15);
  EXPECT_EQ(flight.filter.estimate().mode, FilterMode::lost);
  flight.poses_on = true;
  flight.run_until(15.02);
  EXPECT_EQ(flight.filter.counters().restarts, 1u);
  flight.run_until(16);
  EXPECT_EQ(flight.filter.estimate().mode, FilterMode::ready);
  EXPECT_LT(flight.error().head<3>().norm(), 0.01);
  EXPECT_LT(flight.error().segment<3>(3).norm(), 0.05);
}

/// Hovering at the origin; IMU at 500 Hz from `from` to `to` (ticks of 2 ms).
void hover(ErrorStateFilter& filter, int from, int to) {
  for (int k = from; k < to; ++k) filter.update(ImuSample{k * 2'000'000ll, {0, 0, 9.81}, Vector3::Zero()});
}
PoseMeasurement pose_at(int tick, const Vector3& p) {
  return {tick * 2'000'000ll, {p, Matrix3::Identity()}, 0.001, 0.003};
}

TEST(ErrorStateFilterTest, OneWildPoseIsRefusedAndAPersistentOneBelieved) {
  ErrorStateFilter filter;
  for (int k = 0; k < 500; k += 5) {
    hover(filter, k, k + 5);
    filter.update(pose_at(k + 4, Vector3::Zero()));
  }
  hover(filter, 500, 505);
  EXPECT_EQ(filter.update(pose_at(504, {1, 0, 0})), PoseVerdict::rejected);
  EXPECT_LT(filter.estimate().X_WB.p.norm(), 1e-3);
  int k = 505;
  PoseVerdict verdict = PoseVerdict::rejected;
  for (; k < 1000 && verdict == PoseVerdict::rejected; k += 5) {
    hover(filter, k, k + 5);
    verdict = filter.update(pose_at(k + 4, {1, 0, 0}));
  }
  EXPECT_EQ(verdict, PoseVerdict::started);
  EXPECT_NEAR((k - 505) * 0.002, 0.5, 0.02);
  EXPECT_NEAR(filter.estimate().X_WB.p.x(), 1, 1e-3);
}

TEST(ErrorStateFilterTest, StartsFromTheFirstPoseAndReadyTakesSeveral) {
  ErrorStateFilter filter;
  EXPECT_EQ(filter.update(pose_at(0, Vector3::Zero())), PoseVerdict::invalid);  // nothing to tie it to
  hover(filter, 0, 10);
  const Matrix3 R = robot::exp_so3({0.1, 0.2, 2.0});
  EXPECT_EQ(filter.update({9 * 2'000'000, {Vector3(1, 2, 3), R}, 0.001, 0.003}), PoseVerdict::started);
  EXPECT_EQ(filter.estimate().mode, FilterMode::initialising);
  EXPECT_LT((filter.estimate().X_WB.p - Vector3(1, 2, 3)).norm() + (filter.estimate().X_WB.R - R).norm(), 1e-9);
}

TEST(ErrorStateFilterTest, RefusesAndCountsWhatItCannotUse) {
  ErrorStateFilter filter;
  hover(filter, 100, 400);
  filter.update(pose_at(390, Vector3::Zero()));
  EXPECT_EQ(filter.update(pose_at(250, Vector3::Zero())), PoseVerdict::too_old);  // 128 samples kept
  EXPECT_EQ(filter.update(pose_at(420, Vector3::Zero())), PoseVerdict::too_new);
  EXPECT_EQ(filter.update(pose_at(404, Vector3::Zero())), PoseVerdict::fused);  // a little ahead of the IMU
  EXPECT_EQ(filter.update(pose_at(399, {std::nan(""), 0, 0})), PoseVerdict::invalid);
  PoseMeasurement skewed = pose_at(399, Vector3::Zero());
  skewed.X_WB.R(0, 0) = 2;
  EXPECT_EQ(filter.update(skewed), PoseVerdict::invalid);
  EXPECT_EQ(filter.update(ImuSample{399 * 2'000'000ll, {0, 0, 9.81}, Vector3::Zero()}), ImuVerdict::repeated);
  EXPECT_EQ(filter.update(ImuSample{398 * 2'000'000ll, {0, 0, 9.81}, Vector3::Zero()}), ImuVerdict::backward);
  EXPECT_EQ(
      filter.update(ImuSample{401 * 2'000'000ll, {0, 0, std::numeric_limits<double>::infinity()}, Vector3::Zero()}),
      ImuVerdict::invalid);
  const FilterCounters& c = filter.counters();
  EXPECT_EQ(c.too_old, 1u);
  EXPECT_EQ(c.too_new, 1u);
  EXPECT_EQ(c.invalid, 2u);
  EXPECT_EQ(c.imu_refused, 3u);
}

TEST(ErrorStateFilterTest, RefusesDeviationsThatAreNone) {
  ErrorStateFilter filter;
  hover(filter, 0, 100);
  for (const double deviation : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    PoseMeasurement m = pose_at(90, Vector3::Zero());
    m.position_std_m = deviation;
    EXPECT_EQ(filter.update(m), PoseVerdict::invalid) << deviation;
    m = pose_at(90, Vector3::Zero());
    m.attitude_std_rad = deviation;
    EXPECT_EQ(filter.update(m), PoseVerdict::invalid) << deviation;
  }
  EXPECT_EQ(filter.update(pose_at(90, Vector3::Zero())), PoseVerdict::started);
}

TEST(ErrorStateFilterTest, OnePoseCountsOnce) {
  ErrorStateFilter filter;
  hover(filter, 0, 100);
  EXPECT_EQ(filter.update(pose_at(80, Vector3::Zero())), PoseVerdict::started);
  EXPECT_EQ(filter.update(pose_at(80, Vector3::Zero())), PoseVerdict::repeated);
  EXPECT_EQ(filter.update(pose_at(90, Vector3::Zero())), PoseVerdict::fused);
  const ErrorStateFilter::Covariance P = filter.covariance();
  EXPECT_EQ(filter.update(pose_at(90, Vector3::Zero())), PoseVerdict::repeated);
  EXPECT_EQ(filter.covariance(), P);
  EXPECT_EQ(filter.counters().repeated, 2u);
}

TEST(ErrorStateFilterTest, AClockSetBackIsNoticedAndOneStampFromTheFutureIsNoEnd) {
  ErrorStateFilter filter;
  for (int k = 1000; k < 1500; k += 5) {
    hover(filter, k, k + 5);
    filter.update(pose_at(k + 4, Vector3::Zero()));
  }
  EXPECT_EQ(filter.estimate().mode, FilterMode::ready);
  hover(filter, 9000, 9001);  // a stamp 15 s ahead
  hover(filter, 1500, 1524);
  EXPECT_EQ(filter.counters().imu_refused, 24u);
  hover(filter, 1524, 1530);  // the 25th in order is believed
  EXPECT_EQ(filter.counters().imu_refused, 24u);
  EXPECT_EQ(filter.estimate().stamp_ns, 1529 * 2'000'000ll);
  for (int k = 1530; k < 1600; k += 5) {
    hover(filter, k, k + 5);
    filter.update(pose_at(k + 4, Vector3::Zero()));
  }
  EXPECT_EQ(filter.estimate().mode, FilterMode::ready);
}

TEST(ErrorStateFilterTest, StampsThatRunBackwardNeverGetThrough) {
  ErrorStateFilter filter;
  hover(filter, 1000, 1010);
  for (int k = 1000; k > 500; --k) hover(filter, k, k + 1);
  EXPECT_EQ(filter.counters().imu_refused, 500u);
  EXPECT_EQ(filter.estimate().stamp_ns, 1009 * 2'000'000ll);
}

TEST(ErrorStateFilterTest, ANewStartDropsBiasesThatNoSensorHas) {
  // Poses that accelerate away while the IMU rests: all of it is taken for a bias, until they come back.
  ErrorStateFilterConfig config;
  config.gate_chi2 = 1e9;
  ErrorStateFilter filter(config);
  for (int k = 0; k < 2000; k += 5) {
    hover(filter, k, k + 5);
    const double t = (k + 4) * 0.002;
    filter.update(pose_at(k + 4, {0.5 * 2 * t * t, 0, 0}));
  }
  EXPECT_GT(filter.estimate().accelerometer_bias.norm(), 1);
  hover(filter, 2100, 2110);  // a gap: lost
  EXPECT_EQ(filter.update(pose_at(2109, Vector3::Zero())), PoseVerdict::started);
  EXPECT_EQ(filter.estimate().accelerometer_bias.norm(), 0);
}

TEST(ErrorStateFilterTest, ClaimsNoPoseBetterThanOneMeasurement) {
  ErrorStateFilter filter;
  for (int k = 0; k < 1000; k += 5) {
    hover(filter, k, k + 5);
    PoseMeasurement m = pose_at(k + 4, Vector3::Zero());
    m.position_std_m = 0.01;
    filter.update(m);
  }
  EXPECT_LT(filter.covariance()(0, 0), 0.5e-4);
  EXPECT_NEAR(filter.estimate().variance[0], 1e-4, 1e-12);
}

TEST(ErrorStateFilterTest, AGapInTheImuForcesANewStart) {
  ErrorStateFilter filter;
  for (int k = 0; k < 500; k += 5) {
    hover(filter, k, k + 5);
    filter.update(pose_at(k + 4, Vector3::Zero()));
  }
  EXPECT_EQ(filter.estimate().mode, FilterMode::ready);
  hover(filter, 600, 605);  // 0.2 s of silence
  EXPECT_EQ(filter.estimate().mode, FilterMode::lost);
  EXPECT_EQ(filter.update(pose_at(604, {0.1, 0, 0})), PoseVerdict::started);
  EXPECT_EQ(filter.counters().imu_gaps, 1u);
  EXPECT_EQ(filter.counters().restarts, 1u);
}

}  // namespace
}  // namespace eciton::estimation
