// docking: two modules, or two chains, in the air; one docks to the other; from goal to latched and view active.
#include <algorithm>
#include <optional>
#include <random>
#include <vector>

#include "deploy/experiments/docking_record.hpp"
#include "deploy/experiments/experiment.hpp"
#include "deploy/experiments/pilot.hpp"
#include "deploy/experiments/report/plots.hpp"

namespace eciton::deploy {
namespace {

constexpr double height_m = 1.5;
constexpr double module_length_m = 0.806;  // docking point to docking point
constexpr double assembly_gap_m = 0.8;     // between the members of a side, before it is a chain
constexpr double ask_limit_s = 30;
constexpr double dock_limit_s = 45;
constexpr double chain_dock_limit_s = 90;
constexpr double held_s = 1.0;  // a latch that lets go again was none
constexpr double assembled_s = 3.0;

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

  void look(const msg::DockingState& follower) {
    if (follower.phase == msg::DockingPhase::approach) keep_once("T2: aligned, approaching", approached_);
    if (follower.phase == msg::DockingPhase::assembly) keep_once("T3: pushing in", assembled_);
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

/// The target's modules first, 1, 2, ...; those nearest to the other side lead each side.
struct Sides {
  std::vector<std::uint32_t> target, follower;
  std::vector<double> heights_m;
};

Sides place_modules(const DockingSides& docking, const Start& start, hal::sim::WorldConfig& world) {
  Sides sides;
  world.modules.clear();
  const auto add = [&](std::vector<std::uint32_t>& side, double x_m, double y_m, double z_m) {
    const auto id = static_cast<std::uint32_t>(world.modules.size() + 1);
    world.modules.push_back({.id = id, .p_WB_m = {start.side * x_m, y_m, 0}});
    sides.heights_m.push_back(z_m);
    side.push_back(id);
  };
  const double apart_m = module_length_m + assembly_gap_m;
  for (std::uint32_t k = 0; k < docking.target_modules; ++k) add(sides.target, -apart_m * k, 0, height_m);
  for (std::uint32_t k = 0; k < docking.follower_modules; ++k) {
    add(sides.follower, module_length_m + start.gap_m + apart_m * k, start.lateral_m, height_m + start.vertical_m);
  }
  return sides;
}

/// Asks again while it is refused, as a person would. The goal that was accepted, or nothing.
std::optional<std::uint64_t> ask_to_dock(Pilot& pilot, Simulation& simulation, std::uint32_t follower,
                                         std::uint32_t target) {
  const double began_s = simulation.elapsed_s();
  while (simulation.elapsed_s() < began_s + ask_limit_s) {
    const std::uint64_t goal = pilot.op().dock(follower, target);
    pilot.wait_until([&] { return pilot.op().report(goal)->progress >= GoalProgress::accepted; }, 5);
    const GoalProgress progress = pilot.op().report(goal)->progress;
    if (progress == GoalProgress::accepted || progress == GoalProgress::succeeded) return goal;
    pilot.wait(1);
  }
  return std::nullopt;
}

/// All of these, and nobody else, fly by one view.
bool in_one_chain(const Pilot& pilot, const std::vector<std::uint32_t>& modules) {
  const KnownModule* first = pilot.fleet().find(modules.front());
  return std::all_of(modules.begin(), modules.end(), [&](std::uint32_t id) {
    const KnownModule* m = pilot.fleet().find(id);
    return m != nullptr && m->in_chain() && m->view->active_epoch == first->view->active_epoch &&
           m->view->members.size() == modules.size();
  });
}

/// One behind the other onto the first.
bool assemble(Pilot& pilot, Simulation& simulation, const std::vector<std::uint32_t>& side) {
  for (std::size_t k = 1; k < side.size(); ++k) {
    const std::vector<std::uint32_t> so_far(side.begin(), side.begin() + static_cast<std::ptrdiff_t>(k) + 1);
    if (!ask_to_dock(pilot, simulation, side[k], side[k - 1]) ||
        !pilot.wait_until([&] { return in_one_chain(pilot, so_far); }, dock_limit_s)) {
      return false;
    }
  }
  return true;
}

/// The state of whichever follower did it.
msg::DockingState follower_state(const Pilot& pilot, const Sides& sides, std::uint64_t goal) {
  for (const std::uint32_t id : sides.follower) {
    const KnownModule* m = pilot.fleet().find(id);
    if (m != nullptr && m->docking && m->docking->role == msg::DockingRole::follower &&
        m->docking->correlation_id == goal) {
      return *m->docking;
    }
  }
  return {};
}

Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  const std::uint64_t seed = trial_seed(config.seed, trial);
  const Start start = draw_start(seed);
  SimulationConfig simulated = config.simulation;
  simulated.world.seed = seed;
  simulated.world.break_what = config.break_what == "weld-off" ? "weld-off" : "";
  simulated.module.docking.claims_muted = config.break_what == "claims-muted";
  const Sides sides = place_modules(config.docking, start, simulated.world);
  Simulation simulation(simulated);
  Pilot pilot(simulation);
  pilot.bring_to_hover(sides.heights_m);
  const bool ready = assemble(pilot, simulation, sides.target) && assemble(pilot, simulation, sides.follower);
  if (sides.heights_m.size() > 2) pilot.wait(assembled_s);

  // Judged by the physics and by all modules' own views, not by what the goal's answer says.
  std::vector<std::uint32_t> all = sides.target;
  all.insert(all.end(), sides.follower.begin(), sides.follower.end());
  const auto linked = [&] { return simulation.world().latched_links() == static_cast<int>(all.size()) - 1; };
  DockingRecord record(simulation, pilot, sides.follower);
  Figures figures;
  const bool pictured = trial == 0;
  if (pictured) figures.stills.push_back(pilot.still("T1: both sides hover"));
  PhaseStills phases(pilot, figures.stills);
  double accepted_s = simulation.elapsed_s();
  bool docked = false, latched = false;
  // The members farthest from each other are named: their chains find out who has the ports.
  const auto goal = ready ? ask_to_dock(pilot, simulation, sides.follower.back(), sides.target.back()) : std::nullopt;
  if (goal) {
    accepted_s = simulation.elapsed_s() - to_s(simulation.now() - pilot.op().report(*goal)->accepted_at);
    const auto is_docked = [&] {
      record.approach(*goal);
      if (pictured) phases.look(follower_state(pilot, sides, *goal));
      if (linked() && !latched) record.latched();
      latched = linked();
      return latched && in_one_chain(pilot, all);
    };
    docked = pilot.wait_until(is_docked, all.size() > 2 ? chain_dock_limit_s : dock_limit_s);
  }
  const double time_s = simulation.elapsed_s() - accepted_s;
  const auto look = [&] {
    record.assembled();
    return false;
  };
  pilot.wait_until(look, held_s);
  const bool success = docked && linked() && in_one_chain(pilot, all);
  if (success) pilot.wait_until(look, assembled_s - held_s);

  if (pictured) figures.stills.push_back(pilot.still(linked() ? "T4: latched, flying as one" : "T4: not latched"));

  const msg::DockingState state = goal ? follower_state(pilot, sides, *goal) : msg::DockingState{};
  figures.metrics = {{"success", success ? 1.0 : 0.0},
                     {"time_s", time_s},
                     {"declared_by_wrench", state.declared_by == msg::DeclaredBy::wrench ? 1.0 : 0.0},
                     {"false_declarations", static_cast<double>(state.false_declarations)},
                     {"recoveries", static_cast<double>(state.recoveries)},
                     {"simulated_s", simulation.elapsed_s()}};
  if (success) record.write(trial, figures);
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
    for (const auto& [name, samples] : trial.series) {
      all.series[name].insert(all.series[name].end(), samples.begin(), samples.end());
    }
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
                                    .summary = "a module or a chain docks to another in flight, again and again",
                                    .modules = 2,
                                    .has_trials = true,
                                    .breaks = {"weld-off", "claims-muted"},
                                    .run_trial = &run_trial,
                                    .summarise = &summarise,
                                    .plots = &docking_plots};

}  // namespace eciton::deploy
