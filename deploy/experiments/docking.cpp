// docking: two modules in the air, one docks to the other; from goal to latched and view active.
#include <algorithm>
#include <random>

#include "deploy/experiments/experiment.hpp"
#include "deploy/experiments/pilot.hpp"
#include "deploy/experiments/report/plots.hpp"

namespace eciton::deploy {
namespace {

constexpr std::uint32_t target = 1, follower = 2;
constexpr double height_m = 1.5;
constexpr double module_length_m = 0.806;  // docking point to docking point
constexpr double ask_limit_s = 30;
constexpr double dock_limit_s = 45;
constexpr double held_s = 1.0;  // a latch that lets go again was none

/// Gap 1.5 +- 0.3 m, lateral +- 0.4, vertical +- 0.3, uniform: the follower behind the target's male port
/// would be in front of it, so it stands on the side of the target's female port or of its male one by turns.
struct Start {
  double gap_m, lateral_m, vertical_m, side;
};

Start draw_start(std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const auto uniform = [&](double half) {
    return half * (2 * (static_cast<double>(generator() >> 11) * 0x1.0p-53) - 1);
  };
  Start start{};
  start.gap_m = 1.5 + uniform(0.3);
  start.lateral_m = uniform(0.4);
  start.vertical_m = uniform(0.3);
  start.side = uniform(1) < 0 ? -1 : 1;
  return start;
}

/// Keeps the moment in which the follower first says that it is aligned, and that it pushes in.
class PhaseStills {
 public:
  PhaseStills(Pilot& pilot, std::vector<Still>& stills) : pilot_(pilot), stills_(stills) {}

  void look() {
    const KnownModule* known = pilot_.fleet().find(follower);
    if (known == nullptr || !known->docking) return;
    if (known->docking->phase == msg::DockingPhase::approach) keep_once("T2: aligned, approaching", approached_);
    if (known->docking->phase == msg::DockingPhase::assembly) keep_once("T3: pushing in", assembled_);
  }

 private:
  void keep_once(const char* title, bool& kept) {
    if (!kept) stills_.push_back(pilot_.still(title));
    kept = true;
  }

  Pilot& pilot_;
  std::vector<Still>& stills_;
  bool approached_ = false, assembled_ = false;
};

Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  const std::uint64_t seed = trial_seed(config.seed, trial);
  const Start start = draw_start(seed);
  SimulationConfig simulated = config.simulation;
  simulated.world.seed = seed;
  simulated.world.break_what = config.break_what == "weld-off" ? "weld-off" : "";
  simulated.module.docking.claims_muted = config.break_what == "claims-muted";
  simulated.world.modules = {
      {.id = target}, {.id = follower, .p_WB_m = {start.side * (module_length_m + start.gap_m), start.lateral_m, 0}}};
  Simulation simulation(simulated);
  Pilot pilot(simulation);
  pilot.bring_to_hover({height_m, height_m + start.vertical_m});

  // Judged by the physics and by both modules' own views, not by what the goal's answer says.
  const auto linked = [&] { return simulation.world().latched_links() == 1; };
  const auto both_active = [&] {
    const KnownModule* a = pilot.fleet().find(target);
    const KnownModule* b = pilot.fleet().find(follower);
    return a != nullptr && b != nullptr && a->in_chain() && b->in_chain() &&
           a->view->active_epoch == b->view->active_epoch;
  };
  Figures figures;
  if (trial == 0) figures.stills.push_back(pilot.still("T1: both hover"));
  PhaseStills phases(pilot, figures.stills);
  const double began_s = simulation.elapsed_s();
  // Asked again while it is refused, as a person would: the clock runs from the accepted goal.
  std::uint64_t goal = 0;
  const auto answered = [&] { return pilot.op().report(goal)->progress >= GoalProgress::accepted; };
  bool accepted = false;
  while (!accepted && simulation.elapsed_s() < began_s + ask_limit_s) {
    goal = pilot.op().dock(follower, target);
    pilot.wait_until(answered, 5);
    accepted = pilot.op().report(goal)->progress == GoalProgress::accepted;
    if (!accepted) pilot.wait(1);
  }
  const double accepted_s = accepted ? to_s(pilot.op().report(goal)->accepted_at - TimePoint{}) : began_s;
  const auto is_docked = [&] {
    if (trial == 0) phases.look();
    return linked() && both_active();
  };
  const bool docked = accepted && pilot.wait_until(is_docked, dock_limit_s);
  const double time_s = to_s(simulation.now() - TimePoint{}) - accepted_s;
  pilot.wait(held_s);
  if (trial == 0) figures.stills.push_back(pilot.still(linked() ? "T4: latched, flying as one" : "T4: not latched"));
  const bool success = docked && linked() && both_active();

  const KnownModule* said = pilot.fleet().find(follower);
  const msg::DockingState state = said != nullptr && said->docking ? *said->docking : msg::DockingState{};
  figures.metrics = {{"success", success ? 1.0 : 0.0},
                     {"time_s", time_s},
                     {"declared_by_wrench", state.declared_by == msg::DeclaredBy::wrench ? 1.0 : 0.0},
                     {"false_declarations", static_cast<double>(state.false_declarations)},
                     {"recoveries", static_cast<double>(state.recoveries)},
                     {"simulated_s", simulation.elapsed_s()}};
  return figures;
}

Figures summarise(const std::vector<Figures>& trials) {
  Figures all;
  all.stills = trials.front().stills;
  double successes = 0, time_s_sum = 0, time_s_max = 0, by_wrench = 0, false_declarations = 0, recoveries = 0;
  double simulated_s = 0;
  for (const Figures& trial : trials) {
    const auto& m = trial.metrics;
    const bool success = m.at("success") > 0;
    successes += m.at("success");
    if (success) {
      time_s_sum += m.at("time_s");
      time_s_max = std::max(time_s_max, m.at("time_s"));
      by_wrench += m.at("declared_by_wrench");
    }
    false_declarations += m.at("false_declarations");
    recoveries += m.at("recoveries");
    simulated_s += m.at("simulated_s");
    all.series["success"].push_back(m.at("success"));
    all.series["time_s"].push_back(m.at("time_s"));
    all.series["recoveries"].push_back(m.at("recoveries"));
  }
  all.metrics = {{"trials", static_cast<double>(trials.size())},
                 {"successes", successes},
                 {"time_s_mean", successes > 0 ? time_s_sum / successes : 0},
                 {"time_s_max", time_s_max},
                 {"declared_by_wrench", by_wrench},
                 {"false_declarations", false_declarations},
                 {"recoveries", recoveries},
                 {"simulated_s", simulated_s}};
  return all;
}

}  // namespace

const Experiment docking_experiment{.name = "docking",
                                    .summary = "a module docks to another in flight, again and again",
                                    .modules = 2,
                                    .has_trials = true,
                                    .breaks = {"weld-off", "claims-muted"},
                                    .run_trial = &run_trial,
                                    .summarise = &summarise,
                                    .plots = &docking_plots};

}  // namespace eciton::deploy
