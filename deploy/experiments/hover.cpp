// hover: one module takes off, hovers and lands.
#include <cmath>

#include "core/robot/arrays.hpp"
#include "deploy/experiments/experiment.hpp"
#include "deploy/experiments/pilot.hpp"

namespace eciton::deploy {
namespace {

constexpr double height_m = 1.5;
constexpr double hover_s = 15;
constexpr double settle_s = 3;

Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  SimulationConfig simulated = config.simulation;
  simulated.world.seed = trial_seed(config.seed, trial);
  if (simulated.world.modules.empty()) simulated.world.modules = {{.id = 1}};
  Simulation simulation(simulated);
  Pilot pilot(simulation);
  const std::uint32_t id = simulation.id(0);
  auto states = simulation.listener(0).create_reader(topics::module_state);
  pilot.bring_to_hover(std::vector<double>(simulation.size(), height_m));
  const double took_off_s = simulation.elapsed_s();
  pilot.wait(settle_s);

  Figures figures;
  double position_m = 0, attitude_rad = 0, estimated_m = 0, estimated_rad = 0;
  std::size_t samples = 0;
  const auto start = hal::sim::ModuleStart(simulated.world.modules.front());
  const robot::Vector3 goal_W(start.p_WB_m[0], start.p_WB_m[1], height_m);
  const double until_s = simulation.elapsed_s() + hover_s;
  while (simulation.elapsed_s() < until_s) {
    pilot.wait(0.02);
    const auto truth = simulation.world().truth_pose(id);
    const auto state = states.take_newest();
    if (!state) continue;
    const robot::Matrix3 R_WM = robot::rotation(state->value.q_WM);
    // Where it took off is where it stood; its heading is what it was on the ground.
    const double heading_rad = std::atan2(truth.X_WB.R(1, 0), truth.X_WB.R(0, 0));
    const robot::Matrix3 upright = robot::exp_so3({0, 0, heading_rad});
    const double error_m = (truth.p_WM_m - goal_W).norm();
    position_m += error_m;
    attitude_rad += robot::log_so3(upright.transpose() * truth.X_WB.R).norm();
    estimated_m += (robot::vector(state->value.p_WM_m) - truth.p_WM_m).norm();
    estimated_rad += robot::log_so3(R_WM.transpose() * truth.X_WB.R).norm();
    figures.series["time_s"].push_back(simulation.elapsed_s());
    figures.series["position_error_m"].push_back(error_m);
    ++samples;
  }
  figures.stills.push_back(pilot.still("hovering"));
  const auto n = static_cast<double>(samples);
  const GoalProgress landing = pilot.follow(pilot.op().land(id), 30);
  figures.metrics = {{"position_error_m_mean", position_m / n},
                     {"attitude_error_rad_mean", attitude_rad / n},
                     {"estimation_error_m_mean", estimated_m / n},
                     {"estimation_error_rad_mean", estimated_rad / n},
                     {"hovering_after_s", took_off_s},
                     {"landed", landing == GoalProgress::succeeded ? 1.0 : 0.0}};
  return figures;
}

}  // namespace

const Experiment hover_experiment{.name = "hover",
                                  .summary = "one module takes off, hovers and lands",
                                  .modules = 1,
                                  .has_trials = false,
                                  .breaks = {},
                                  .run_trial = &run_trial,
                                  .summarise = &only_trial};

}  // namespace eciton::deploy
