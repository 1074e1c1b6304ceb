// wind: a wind of 4 N from the side sets in on a chain and stays; contact wrenches should not notice.
#include <algorithm>

#include "core/robot/arrays.hpp"
#include "deploy/experiments/chain_flight.hpp"

namespace eciton::deploy {
namespace {

constexpr std::uint32_t modules = 3;
constexpr double wind_N = 4;
constexpr double window_s = 60, transient_s = 8;  // means of what wakes do need so long to be of a tenth of the bar

Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  ChainFlight flight(config, trial, modules);
  flight.assemble();
  Recorder& recorder = flight.recorder();
  recorder.start();
  flight.pilot().wait(window_s);
  const std::vector<robot::Wrench> before = recorder.mean_wrenches();
  const double onset_s = flight.simulation().elapsed_s();
  const robot::Vector3 calm_W = robot::vector(config.simulation.world.wind_N);
  flight.simulation().world().set_wind(calm_W + robot::Vector3(0, wind_N, 0));
  recorder.start();
  flight.pilot().wait(transient_s);
  const FlightFigures transient = recorder.figures();
  recorder.start();
  flight.pilot().wait(window_s);
  const std::vector<robot::Wrench> after = recorder.mean_wrenches();
  const FlightFigures steady = recorder.figures();

  double shift_N = 0, shift_Nm = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    shift_N = std::max(shift_N, (after[k].force - before[k].force).norm());
    shift_Nm = std::max(shift_Nm, (after[k].moment - before[k].moment).norm());
  }
  Figures out;
  out.series = recorder.series();
  out.series["mark_s"] = {onset_s};
  out.metrics = {{"contact_force_N_shift", shift_N},
                 {"contact_torque_Nm_shift", shift_Nm},
                 {"contact_force_N_max", transient.contact_force_N_max},
                 {"base_position_error_m_max", transient.position_error_m_max},
                 {"base_position_error_m_mean", steady.position_error_m_mean}};
  return out;
}

}  // namespace

const Experiment wind_experiment{.name = "wind",
                                 .summary = "a common wind sets in on a chain; contact wrenches should not notice",
                                 .modules = modules,
                                 .has_trials = false,
                                 .breaks = {},
                                 .run_trial = &run_trial,
                                 .summarise = &only_trial};

}  // namespace eciton::deploy
