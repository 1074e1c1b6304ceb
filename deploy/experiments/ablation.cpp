// ablation: two modules bend their joints with each of the contact-wrench laws in turn: none, the paper's, ours; the
// same gains, world and seed for all. Fig. S2 of LEGION.
#include <array>

#include "deploy/experiments/chain_flight.hpp"
#include "deploy/experiments/report/plots.hpp"

namespace eciton::deploy {
namespace {

/// Ours twice: whole, and with stiff joints, which is the law alone.
constexpr std::array variants{"none", "paper", "local", "local_stiff"};
constexpr double bend_rad = 0.8;
constexpr double hold_s = 10;  // straight before, and bent after
constexpr double end_s = 2;

/// A trial is a variant.
Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  ExperimentConfig with_law = config;
  control::ControlConfig& control = with_law.simulation.module.control;
  const std::string variant = variants[trial];
  control.law = variant == "local_stiff" ? "local" : variant;
  // The same pose control for all, the paper's: every member's integral runs. The gains are those of free flight, by
  // which what is left uncontrolled shows sooner. Joints give way only where that is part of the law.
  control.integrate_all = true;
  control.stiffness = 1;
  // Biases that make opposing integrals wind up: as large as they may be, and the joints' on the side to which these
  // bend, so that every seed shows it. On the other side they take from what grows: the torque without a law is then
  // 0.07 Nm in the mildest of twelve seeds, where our law leaves 0.014 Nm.
  with_law.simulation.world.full_joint_offset = true;
  with_law.simulation.world.mocap.position_bias_m = 0.003;
  if (variant != "local") with_law.simulation.module.joints.relief.rate_1_s = 0;
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
                 {"kp_1_s2", control::gains_free().kp_1_s2.x()},
                 {"ap_1_s2", control::gains_free().ap_1_s2.x()},
                 {"is_configured", config.simulation.module.control.law == variant ? 1.0 : 0.0}};
  return out;
}

Figures summarise(const std::vector<Figures>& trials) {
  Figures all;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    const std::string law = variants[k];
    const Figures& one = trials[k];
    for (const auto& [name, value] : one.metrics) {
      if (name == "is_configured") continue;
      all.metrics[name + "_" + law] = value;
      if (one.metrics.at("is_configured") > 0) all.metrics[name] = value;
    }
    all.series["time_s"] = one.series.at("time_s");
    all.series["contact_force_N_" + law] = one.series.at("contact_force_N_1");
    all.series["contact_torque_Nm_" + law] = one.series.at("contact_torque_Nm_1");
    all.series["joint_rad"] = one.series.at("joint_rad_1");
  }
  // The ratios that the bars are about.
  for (const char* quantity : {"contact_force_N_mean", "contact_torque_Nm_mean"}) {
    const auto of = [&](const char* law) { return all.metrics.at(std::string(quantity) + "_" + law); };
    all.metrics[std::string(quantity) + "_none_by_local"] = of("none") / of("local");
    all.metrics[std::string(quantity) + "_local_by_paper"] = of("local") / of("paper");
  }
  return all;
}

}  // namespace

const Experiment ablation_experiment{
    .name = "ablation",
    .summary = "two modules bend with no contact-wrench law, the paper's, and ours",
    .modules = 2,
    .has_trials = false,
    .runs = [](const ExperimentConfig&) { return static_cast<std::uint32_t>(variants.size()); },
    .breaks = {},
    .run_trial = &run_trial,
    .summarise = &summarise,
    .plots = &ablation_plots};

}  // namespace eciton::deploy
