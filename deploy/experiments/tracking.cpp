// tracking: one module flies three laps of a path through space, turning about all axes on the way. Fig. S1 of
// LEGION.
#include <cmath>
#include <numbers>

#include "core/robot/arrays.hpp"
#include "deploy/experiments/chain_flight.hpp"
#include "deploy/experiments/path_reference.hpp"
#include "deploy/experiments/report/plots.hpp"

namespace eciton::deploy {
namespace {

constexpr int laps = 3, waypoints_per_lap = 10;
constexpr double speed_m_s = 0.8;
constexpr double limit_s = 120;

/// At `u` radians of a lap: a figure of eight that climbs and sinks, with roll, pitch and yaw of their own.
robot::Pose on_lap(double u, const robot::Vector3& centre_W) {
  const robot::Vector3 offset(std::sin(u), 0.6 * std::sin(2 * u), 0.3 * std::sin(u));
  const robot::Matrix3 R = (Eigen::AngleAxisd(0.5 * std::sin(u), robot::Vector3::UnitZ()) *
                            Eigen::AngleAxisd(0.4 * std::sin(2 * u), robot::Vector3::UnitY()) *
                            Eigen::AngleAxisd(0.4 * std::sin(u), robot::Vector3::UnitX()))
                               .toRotationMatrix();
  return {centre_W + offset, R};
}

Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  ChainFlight flight(config, trial, 1);
  flight.assemble();
  std::vector<robot::Pose> waypoints;
  for (int k = 1; k <= laps * waypoints_per_lap; ++k) {
    waypoints.push_back(on_lap(2 * std::numbers::pi * k / waypoints_per_lap, flight.home().p));
  }
  const bool flown = fly_path(flight, waypoints, speed_m_s, limit_s);
  const FlightFigures f = flight.recorder().figures();
  Figures out;
  out.series = flight.recorder().series();
  out.metrics = {{"position_error_m_mean", f.position_error_m_mean},
                 {"position_error_m_max", f.position_error_m_max},
                 {"attitude_error_rad_mean", f.attitude_error_rad_mean},
                 {"attitude_error_rad_max", f.attitude_error_rad_max},
                 {"speed_m_s_max", f.speed_m_s_max},
                 {"laps", flown ? laps : 0.0}};
  return out;
}

}  // namespace

const Experiment tracking_experiment{.name = "tracking",
                                     .summary = "one module flies three laps with its attitude moving on its own",
                                     .modules = 1,
                                     .has_trials = false,
                                     .breaks = {},
                                     .run_trial = &run_trial,
                                     .summarise = &only_trial,
                                     .plots = &tracking_plots};

}  // namespace eciton::deploy
