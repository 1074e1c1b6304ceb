// ablation: two modules bend their joints with each of the contact-wrench laws in turn: none, the paper's, ours; the
// same gains, world and seed. Fig. S2 of LEGION.
#include <array>

#include "deploy/experiments/chain_flight.hpp"

namespace eciton::deploy {
namespace {

constexpr std::array laws{"none", "paper", "local"};
constexpr double bend_rad = 0.8;
constexpr double hold_s = 10;  // straight before, and bent after
constexpr double end_s = 2;

/// A trial is a law.
Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  ExperimentConfig with_law = config;
  with_law.simulation.module.control.law = laws[trial];
  ChainFlight flight(with_law, 0, 2);
  flight.assemble();
  flight.recorder().start();
  flight.morph(flight.bow(bend_rad, bend_rad));
  flight.pilot().wait(hold_s - end_s);
  const FlightFigures whole = flight.recorder().figures();
  flight.recorder().start();
  flight.pilot().wait(end_s);
  const FlightFigures end = flight.recorder().figures();
  Figures out;
  out.series = flight.recorder().series();
  out.metrics = {{"contact_force_N_mean", whole.contact_force_N_mean},
                 {"contact_torque_Nm_mean", whole.contact_torque_Nm_mean},
                 {"contact_force_N_end", end.contact_force_N_mean},
                 {"contact_torque_Nm_end", end.contact_torque_Nm_mean},
                 {"joint_torque_Nm_mean", whole.joint_torque_Nm_mean},
                 {"is_configured", config.simulation.module.control.law == laws[trial] ? 1.0 : 0.0}};
  return out;
}

Figures summarise(const std::vector<Figures>& trials) {
  Figures all;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    const std::string law = laws[k];
    const Figures& one = trials[k];
    for (const auto& [name, value] : one.metrics) {
      if (name == "is_configured") continue;
      all.metrics[name + "_" + law] = value;
      if (one.metrics.at("is_configured") > 0) all.metrics[name] = value;
    }
    all.series["time_s"] = one.series.at("time_s");
    all.series["contact_force_N_" + law] = one.series.at("contact_force_N_1");
    all.series["contact_torque_Nm_" + law] = one.series.at("contact_torque_Nm_1");
    all.series["joint_rad_" + law] = one.series.at("joint_rad_1");
  }
  for (const char* quantity : {"contact_force_N_mean", "contact_torque_Nm_mean"}) {
    const auto of = [&](const char* law) { return all.metrics.at(std::string(quantity) + "_" + law); };
    all.metrics[std::string(quantity) + "_none_by_local"] = of("none") / of("local");
    all.metrics[std::string(quantity) + "_local_by_paper"] = of("local") / of("paper");
  }
  return all;
}

}  // namespace

const Experiment ablation_experiment{.name = "ablation",
                                     .summary = "two modules bend with no contact-wrench law, the paper's, and ours",
                                     .modules = 2,
                                     .has_trials = false,
                                     .runs = [](const ExperimentConfig&) { return 3u; },
                                     .breaks = {},
                                     .run_trial = &run_trial,
                                     .summarise = &summarise};

}  // namespace eciton::deploy
