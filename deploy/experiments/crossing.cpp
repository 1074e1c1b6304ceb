// crossing: separated modules on a circle change over to the opposite side through its centre, all at once and at
// one height. Each keeps its distance by what it hears of the others.
#include "deploy/experiments/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "deploy/experiments/pilot.hpp"

namespace eciton::deploy {
namespace {

constexpr double height_m = 1.5;
constexpr double radius_m = 2.5;   // four stand on the corners of a square of 3.5 m
constexpr double spacing_m = 1.8;  // at the least: more modules, a larger circle
constexpr double speed_m_s = 0.8;
constexpr double sample_s = 0.02;
constexpr double there_m = 0.15;

double least_distance_m(Simulation& simulation) {
  double least_m = 1e9;
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const auto a = simulation.world().truth_pose(simulation.id(i)),
                 b = simulation.world().truth_pose(simulation.id(k));
      least_m = std::min(least_m, (a.p_WM_m - b.p_WM_m).norm());
    }
  }
  return least_m;
}

Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  const std::uint32_t modules = config.modules > 0 ? std::max(config.modules, 2u) : 4;
  const double n = modules, step_rad = 2 * std::numbers::pi / n;
  const double circle_m = std::max(radius_m, spacing_m / (2 * std::sin(step_rad / 2)));
  Crossing crossing;
  for (std::uint32_t k = 0; k < modules; ++k) {
    const double at_rad = (k + 0.5) * step_rad;
    const robot::Vector3 from(circle_m * std::cos(at_rad), circle_m * std::sin(at_rad), height_m);
    crossing.starts_W.push_back(from);
    crossing.goals_W.emplace_back(-from.x(), -from.y(), height_m);
    crossing.speed_m_s.push_back(speed_m_s);
  }
  return fly_crossing(config, trial_seed(config.seed, trial), crossing);
}

Figures summarise(const std::vector<Figures>& trials) {
  Figures all = trials.front();
  for (const Figures& trial : trials) {
    auto& m = all.metrics;
    m["distance_m_min"] = std::min(m["distance_m_min"], trial.metrics.at("distance_m_min"));
    m["arrived"] = std::min(m["arrived"], trial.metrics.at("arrived"));
    m["time_s"] = std::max(m["time_s"], trial.metrics.at("time_s"));
  }
  return all;
}

}  // namespace

Figures fly_crossing(const ExperimentConfig& config, std::uint64_t seed, const Crossing& crossing) {
  SimulationConfig simulated = config.simulation;
  simulated.world.seed = seed;
  if (config.break_what == "no-separation") simulated.module.control.separation = false;
  simulated.world.modules.clear();
  std::vector<double> heights_m;
  for (const robot::Vector3& start_W : crossing.starts_W) {
    const auto id = static_cast<std::uint32_t>(simulated.world.modules.size() + 1);
    simulated.world.modules.push_back({.id = id, .p_WB_m = {start_W.x(), start_W.y(), 0}});
    heights_m.push_back(start_W.z());
  }
  Simulation simulation(simulated);
  Pilot pilot(simulation);
  pilot.bring_to_hover(heights_m);

  Figures figures;
  std::vector<std::uint64_t> goals;
  for (std::size_t k = 0; k < simulation.size(); ++k) {
    const robot::Vector3& goal = crossing.goals_W[k];
    goals.push_back(pilot.op().go_to(simulation.id(k), {goal.x(), goal.y(), goal.z()}, 0, crossing.speed_m_s[k]));
  }
  const double began_s = simulation.elapsed_s();
  const auto over = [&](std::uint64_t goal) { return is_over(pilot.op().report(goal)->progress); };
  double least_m = 1e9;
  while (simulation.elapsed_s() < began_s + crossing.limit_s && !std::all_of(goals.begin(), goals.end(), over)) {
    pilot.wait(sample_s);
    const double now_m = least_distance_m(simulation);
    least_m = std::min(least_m, now_m);
    figures.series["time_s"].push_back(simulation.elapsed_s() - began_s);
    figures.series["distance_m_min"].push_back(now_m);
    for (std::size_t k = 0; k < simulation.size(); ++k) {
      const auto truth = simulation.world().truth_pose(simulation.id(k));
      const std::string number = std::to_string(simulation.id(k));
      figures.series["x_m_" + number].push_back(truth.p_WM_m.x());
      figures.series["y_m_" + number].push_back(truth.p_WM_m.y());
    }
  }
  double arrived = 0;
  for (std::size_t k = 0; k < simulation.size(); ++k) {
    const double off_m = (simulation.world().truth_pose(simulation.id(k)).p_WM_m - crossing.goals_W[k]).norm();
    if (pilot.op().report(goals[k])->progress == GoalProgress::succeeded && off_m < there_m) ++arrived;
  }
  figures.metrics = {{"distance_m_min", least_m}, {"arrived", arrived}, {"time_s", simulation.elapsed_s() - began_s}};
  return figures;
}

const Experiment crossing_experiment{.name = "crossing",
                                     .summary = "separated modules exchange places through one point",
                                     .modules = 4,
                                     .has_trials = false,
                                     .breaks = {"no-separation"},
                                     .run_trial = &run_trial,
                                     .summarise = &summarise};

}  // namespace eciton::deploy
