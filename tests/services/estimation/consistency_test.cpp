// Is the state filter honest? Monte Carlo over flights known in closed form, with sensors as noisy as the filter
// assumes: its errors, its innovations and their whiteness within the bounds that chi-squared gives; and controls,
// a filter that is told a wrong noise or no delay, that must be found out.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "tests/services/estimation/simulated_flight.hpp"

namespace eciton::estimation {
namespace {

constexpr int runs = 50;
constexpr double settled_s = 2, end_s = 6, look_s = 1;
constexpr int lags = 10;
/// Of the standard normal: some 70 comparisons are made below, so that each may fail once in 6000 times.
constexpr double z_bound = 3.6;

/// Mean of `samples` chi-squared numbers of `freedom`: where it lies, z standard deviations off (Wilson-Hilferty).
double chi2_mean(double freedom, double samples, double z) {
  const double n = freedom * samples, c = 2 / (9 * n);
  return freedom * std::pow(1 - c + z * std::sqrt(c), 3);
}
void expect_honest(double mean, double freedom, double samples, const std::string& of) {
  EXPECT_GT(mean, chi2_mean(freedom, samples, -z_bound)) << of << ": claims too little";
  EXPECT_LT(mean, chi2_mean(freedom, samples, z_bound)) << of << ": claims too much";
}

struct Consistency {
  // Error squared, normalised by the filter's own covariance, mean over the runs: at each second, of all 15 states
  // and of position, velocity, attitude, gyroscope and accelerometer bias alone.
  struct Errors {
    double all = 0;
    std::array<double, 5> part{};
  };
  std::vector<Errors> errors;
  double innovations = 0;               // normalised and squared, mean over the runs and all measurements
  double measurements = 0;              // their number
  std::array<double, lags + 1> echo{};  // correlation of the whitened innovations with those k earlier
  std::uint64_t restarts = 0, rejected = 0;
};

ErrorStateFilterConfig told_the_truth(const FlightConfig& flight) {
  ErrorStateFilterConfig config;
  config.accelerometer_bias_std_initial_m_s2 = flight.accelerometer_bias_std;
  config.gyroscope_bias_std_initial_rad_s = flight.gyroscope_bias_std;
  config.attitude_std_min_rad = config.position_std_min_m = 0;
  config.gate_chi2 = 1e9;  // the gate would hide what is tested here
  return config;
}

Consistency examine(const FlightConfig& flight_config) {
  Consistency out;
  out.errors.resize(static_cast<std::size_t>((end_s - settled_s) / look_s) + 1);
  for (unsigned seed = 1; seed <= runs; ++seed) {
    SimulatedFlight flight(seed, flight_config, told_the_truth(flight_config));
    std::vector<Vector6> white;
    flight.on_fused = [&](const Innovation& innovation) {
      if (flight.t < settled_s) return;
      white.push_back(innovation.covariance.llt().matrixL().solve(innovation.value));
      out.innovations += innovation.chi2;
    };
    for (std::size_t k = 0; k < out.errors.size(); ++k) {
      flight.run_until(settled_s + static_cast<double>(k) * look_s);
      const Eigen::Matrix<double, 15, 1> e = flight.error();
      const ErrorStateFilter::Covariance& P = flight.filter.covariance();
      out.errors[k].all += e.dot(P.ldlt().solve(e)) / runs;
      for (int part = 0; part < 5; ++part) {
        const Vector3 of = e.segment<3>(3 * part);
        out.errors[k].part[static_cast<std::size_t>(part)] +=
            of.dot(P.block<3, 3>(3 * part, 3 * part).ldlt().solve(of)) / runs;
      }
    }
    for (std::size_t lag = 0; lag <= lags; ++lag) {
      for (std::size_t k = lag; k < white.size(); ++k) out.echo[lag] += white[k].dot(white[k - lag]);
    }
    out.measurements += static_cast<double>(white.size());
    out.restarts += flight.filter.counters().restarts;
  }
  out.innovations /= out.measurements;
  for (std::size_t lag = 1; lag <= lags; ++lag) out.echo[lag] /= out.echo[0];
  return out;
}

const FlightConfig mocap{};
const FlightConfig lidar_10_Hz{.pose_Hz = 10, .latency_s = 0.1, .position_std_m = 3e-3};
const FlightConfig lidar_20_Hz{.pose_Hz = 20, .latency_s = 0.06, .position_std_m = 3e-3};
const FlightConfig lidar_50_Hz{.pose_Hz = 50, .latency_s = 0.03, .position_std_m = 3e-3};

void expect_consistent(const FlightConfig& flight) {
  const Consistency found = examine(flight);
  const char* parts[] = {"position", "velocity", "attitude", "gyroscope bias", "accelerometer bias"};
  for (std::size_t k = 0; k < found.errors.size(); ++k) {
    const std::string when = " after " + std::to_string(settled_s + static_cast<double>(k) * look_s) + " s";
    expect_honest(found.errors[k].all, 15, runs, "state" + when);
    for (std::size_t part = 0; part < 5; ++part) {
      expect_honest(found.errors[k].part[part], 3, runs, parts[part] + when);
    }
  }
  expect_honest(found.innovations, 6, found.measurements, "innovations");
  // Of n independent unit normal vectors of 6, the correlation is spread by 1 / sqrt(6 n).
  for (std::size_t lag = 1; lag <= lags; ++lag) {
    EXPECT_LT(std::abs(found.echo[lag]), z_bound / std::sqrt(6 * found.measurements)) << "not white at lag " << lag;
  }
  EXPECT_EQ(found.restarts, 0U);
}

TEST(ConsistencyTest, MotionCaptureAt100Hz) { expect_consistent(mocap); }
TEST(ConsistencyTest, LidarAt10HzAnd100msLate) { expect_consistent(lidar_10_Hz); }
TEST(ConsistencyTest, LidarAt20HzAnd60msLate) { expect_consistent(lidar_20_Hz); }
TEST(ConsistencyTest, LidarAt50HzAnd30msLate) { expect_consistent(lidar_50_Hz); }

TEST(ConsistencyTest, NegativeControlADeviationClaimedThreeTimesTooSmallIsFoundOut) {
  FlightConfig liar = mocap;
  liar.claimed_share = 1.0 / 3;
  const Consistency found = examine(liar);
  EXPECT_GT(found.errors.back().all, 2 * chi2_mean(15, runs, z_bound));
  EXPECT_GT(found.errors.back().part[0], 2 * chi2_mean(3, runs, z_bound));
  EXPECT_GT(found.innovations, 4 * 6.0) << "up to nine times what it expects";
  EXPECT_LT(found.echo[1], -0.05) << "it believes each measurement too much, and takes it back at the next";
}

TEST(ConsistencyTest, NegativeControlADeviationClaimedThreeTimesTooLargeIsFoundOut) {
  FlightConfig timid = mocap;
  timid.claimed_share = 3;
  const Consistency found = examine(timid);
  EXPECT_LT(found.errors.back().all, chi2_mean(15, runs, -z_bound));
  EXPECT_LT(found.innovations, 6.0 / 4);
}

TEST(ConsistencyTest, NegativeControlAnIgnoredDelayIsFoundOut) {
  for (FlightConfig deaf : {mocap, lidar_20_Hz}) {
    deaf.stamped_on_arrival = true;
    const Consistency found = examine(deaf);
    EXPECT_GT(found.errors.back().all, 3 * chi2_mean(15, runs, z_bound));
    EXPECT_GT(found.innovations, chi2_mean(6, found.measurements, 2 * z_bound));
    EXPECT_GT(found.echo[1], 2 * z_bound / std::sqrt(6 * found.measurements))
        << "the error stays from one to the next";
  }
}

TEST(ConsistencyTest, StaysHonestWhileItDeadReckonsAndAfter) {
  double blind = 0, again = 0;
  for (unsigned seed = 1; seed <= runs; ++seed) {
    SimulatedFlight flight(seed, mocap, told_the_truth(mocap));
    const auto normalised = [&] {
      const Eigen::Matrix<double, 15, 1> e = flight.error();
      return e.dot(flight.filter.covariance().ldlt().solve(e)) / runs;
    };
    flight.run_until(3);
    flight.poses_on = false;
    flight.run_until(4.5);
    EXPECT_EQ(flight.filter.estimate().mode, FilterMode::dead_reckoning);
    blind += normalised();
    flight.poses_on = true;
    flight.run_until(5);
    EXPECT_EQ(flight.filter.estimate().mode, FilterMode::ready);
    again += normalised();
  }
  expect_honest(blind, 15, runs, "blind for 1.5 s");
  expect_honest(again, 15, runs, "0.5 s after poses came back");
}

TEST(ConsistencyTest, AfterAJumpOfThePosesItStartsAnewAndIsHonestAgain) {
  // Here the gate is on, as in flight. What the biases were is kept, so that it claims too little of them.
  double position = 0, velocity = 0;
  for (unsigned seed = 1; seed <= runs; ++seed) {
    ErrorStateFilterConfig config = told_the_truth(mocap);
    config.gate_chi2 = ErrorStateFilterConfig{}.gate_chi2;
    SimulatedFlight flight(seed, mocap, config);
    flight.run_until(3);
    flight.jump = {1, -0.5, 0.2};
    flight.run_until(3.4);
    EXPECT_EQ(flight.filter.counters().restarts, 0U);
    EXPECT_LT(flight.error().head<3>().norm(), 0.05) << "it flies on by the IMU";
    flight.run_until(5.5);
    EXPECT_EQ(flight.filter.counters().restarts, 1U);
    EXPECT_EQ(flight.filter.estimate().mode, FilterMode::ready);
    Eigen::Matrix<double, 15, 1> e = flight.error();
    e.head<3>() += flight.jump;  // in the frame the poses have now
    const ErrorStateFilter::Covariance& P = flight.filter.covariance();
    position += e.head<3>().dot(P.block<3, 3>(0, 0).ldlt().solve(e.head<3>())) / runs;
    velocity += e.segment<3>(3).dot(P.block<3, 3>(3, 3).ldlt().solve(e.segment<3>(3))) / runs;
  }
  expect_honest(position, 3, runs, "position after a new start");
  expect_honest(velocity, 3, runs, "velocity after a new start");
}

TEST(ConsistencyTest, AnAttitudeBiasOfTenMilliradiansDoesNoHarm) {
  // It reads as an accelerometer bias of 0.1 m/s^2, and as another one when the body tilts.
  FlightConfig biased = mocap;
  biased.attitude_bias_rad = {0.007, -0.007, 0};
  double position = 0, velocity = 0, attitude = 0;
  int samples = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SimulatedFlight flight(seed, biased, {});
    for (double t = 3; t < 10; t += 0.05, ++samples) {
      flight.run_until(t);
      const auto e = flight.error();
      position = std::max(position, e.segment<3>(0).norm());
      velocity += e.segment<3>(3).squaredNorm();
      attitude = std::max(attitude, e.segment<3>(6).norm());
    }
    EXPECT_EQ(flight.filter.counters().rejected, 0U);
  }
  EXPECT_LT(position, 0.005);
  EXPECT_LT(std::sqrt(velocity / samples), 0.015);
  EXPECT_LT(attitude, 0.015) << "the bias itself, and a little noise";
}

}  // namespace
}  // namespace eciton::estimation
