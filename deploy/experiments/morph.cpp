// morph: modules dock one by one, the chain bends in three dimensions and straightens, and separates one by one.
// Fig. 4 of LEGION.
#include "deploy/experiments/chain_flight.hpp"
#include "deploy/experiments/report/plots.hpp"

namespace eciton::deploy {
namespace {

constexpr std::uint32_t modules = 3;
constexpr double yaw_rad = 0.6, pitch_rad = 0.3;
constexpr double pause_s = 2;

Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  ExperimentConfig broken = config;
  broken.simulation.module.estimation.zeroing = config.break_what != "no-zeroing";
  broken.simulation.module.docking.require_zeroed = config.break_what != "no-zeroing";
  broken.simulation.module.control.law_sign = config.break_what == "wrong-sign" ? -1 : 1;
  ChainFlight flight(broken, trial, modules);
  std::vector<double> marks;
  Figures out;
  const auto keep = [&](const char* title) { out.stills.push_back(flight.pilot().still(title)); };
  const auto mark = [&] { marks.push_back(flight.simulation().elapsed_s()); };
  flight.assemble();
  const bool assembled = flight.pilot().members(flight.first()).size() == flight.size() &&
                         flight.simulation().world().latched_links() + 1 == static_cast<int>(flight.size());

  keep("Docked one by one: a straight chain");
  flight.recorder().start();
  mark();
  for (const auto& [yaw, pitch] : {std::pair{yaw_rad, 0.0}, {yaw_rad, pitch_rad}, {0.0, 0.0}}) {
    flight.morph(flight.bow(yaw, pitch));
    mark();
    if (yaw != 0) keep(pitch == 0 ? "Bent in the plane" : "Bent in three dimensions");
    flight.pilot().wait(pause_s);
  }
  const FlightFigures f = flight.recorder().figures();
  flight.recorder().stop();
  flight.pilot().separate();
  flight.pilot().wait(pause_s);
  keep("Separated");

  out.series = flight.recorder().series();
  out.series["mark_s"] = marks;
  out.metrics = {{"contact_force_N_mean", f.contact_force_N_mean},
                 {"contact_force_N_max", f.contact_force_N_max},
                 {"contact_force_N_mean_estimated", f.contact_force_N_mean_estimated},
                 {"contact_torque_Nm_mean", f.contact_torque_Nm_mean},
                 {"contact_torque_Nm_mean_estimated", f.contact_torque_Nm_mean_estimated},
                 {"joint_torque_Nm_mean", f.joint_torque_Nm_mean},
                 {"joint_torque_Nm_max", f.joint_torque_Nm_max},
                 {"joint_speed_rad_s_max", f.joint_speed_rad_s_max},
                 {"base_position_error_m_mean", f.position_error_m_mean},
                 {"base_attitude_error_rad_mean", f.attitude_error_rad_mean},
                 {"assembled", assembled ? 1.0 : 0.0},
                 {"separated", flight.simulation().world().latched_links() == 0 ? 1.0 : 0.0}};
  return out;
}

}  // namespace

const Experiment morph_experiment{.name = "morph",
                                  .summary = "modules dock one by one, bend as a chain, and separate one by one",
                                  .modules = modules,
                                  .has_trials = false,
                                  .breaks = {"no-zeroing", "wrong-sign"},
                                  .run_trial = &run_trial,
                                  .summarise = &only_trial,
                                  .plots = &morph_plots};

}  // namespace eciton::deploy
