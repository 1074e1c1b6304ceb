// forest: outdoors, by LiDAR-inertial odometry and in gusts: two modules dock, morph and separate.
#include "deploy/experiments/chain_flight.hpp"
#include "deploy/experiments/report/plots.hpp"

namespace eciton::deploy {
namespace {

constexpr std::uint32_t modules = 2;
constexpr double bend_rad = 0.6;
constexpr double pause_s = 2;
constexpr double gust_N = 1;

Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  ExperimentConfig outdoors = config;
  outdoors.simulation.world.sensing = "lio";
  outdoors.simulation.module.airframe = "legion-lidar";
  if (outdoors.simulation.world.gust_N == 0) outdoors.simulation.world.gust_N = gust_N;
  ChainFlight flight(outdoors, trial, modules);
  flight.assemble();
  Recorder& recorder = flight.recorder();
  std::vector<double> marks;
  Figures out;
  out.stills.push_back(flight.pilot().still("Docked"));
  recorder.start();
  for (const double bend : {bend_rad, 0.0}) {
    marks.push_back(flight.simulation().elapsed_s());
    flight.morph(flight.bow(bend, bend / 2));
    if (bend > 0) out.stills.push_back(flight.pilot().still("Bent"));
    flight.pilot().wait(pause_s);
  }
  const FlightFigures f = recorder.figures();
  recorder.stop();
  flight.pilot().separate();

  out.series = recorder.series();
  out.series["mark_s"] = marks;
  out.metrics = {{"docking_s", flight.pilot().docking_s_max()},
                 {"position_error_m_mean", f.position_error_m_mean},
                 {"attitude_error_rad_mean", f.attitude_error_rad_mean},
                 {"contact_force_N_mean", f.contact_force_N_mean},
                 {"contact_torque_Nm_mean", f.contact_torque_Nm_mean},
                 {"separated", flight.simulation().world().latched_links() == 0 ? 1.0 : 0.0}};
  return out;
}

}  // namespace

const Experiment forest_experiment{.name = "forest",
                                   .summary = "outdoors by LiDAR odometry and in gusts: dock, morph, separate",
                                   .modules = modules,
                                   .has_trials = false,
                                   .breaks = {},
                                   .run_trial = &run_trial,
                                   .summarise = &only_trial,
                                   .plots = &morph_plots};

}  // namespace eciton::deploy
