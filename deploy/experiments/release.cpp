// release: a chain of three lets go at its end, and another one in its middle, where what leaves is a chain itself.
// Who stays should stay, and who leaves should leave along the port's axis only.
#include <algorithm>

#include "core/robot/arrays.hpp"
#include "deploy/experiments/chain_flight.hpp"

namespace eciton::deploy {
namespace {

constexpr std::uint32_t modules = 3;
constexpr double calm_s = 5;    // before
constexpr double limit_s = 30;  // of the undocking
constexpr double after_s = 3;
constexpr double look_s = 0.02;

/// How far modules get from where they were at the release; of those that leave only across the port's axis.
class Displacement {
 public:
  Displacement(Simulation& simulation, std::vector<std::uint32_t> leaving) : simulation_(simulation) {
    for (std::size_t k = 0; k < simulation.size(); ++k) {
      const std::uint32_t id = simulation.id(k);
      const auto truth = simulation.world().truth_pose(id);
      const bool leaves = std::find(leaving.begin(), leaving.end(), id) != leaving.end();
      modules_.push_back({id, truth.p_WM_m, truth.X_WB.R.col(0), leaves});
    }
  }
  double now_m() const {
    double most_m = 0;
    for (const Module& m : modules_) {
      robot::Vector3 moved = simulation_.world().truth_pose(m.id).p_WM_m - m.p_WM;
      if (m.leaves) moved -= moved.dot(m.axis_W) * m.axis_W;
      most_m = std::max(most_m, moved.norm());
    }
    return most_m;
  }

 private:
  struct Module {
    std::uint32_t id;
    robot::Vector3 p_WM, axis_W;
    bool leaves;
  };
  Simulation& simulation_;
  std::vector<Module> modules_;
};

/// A trial is a place to let go at: the end, then the middle.
Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  const bool middle = trial == 1;
  ChainFlight flight(config, 0, modules);
  flight.assemble();
  Pilot& pilot = flight.pilot();
  pilot.wait(calm_s);
  const std::vector<std::uint32_t> chain = pilot.members(flight.first());
  const std::size_t last = chain.size() - 1, cut = middle ? last - 1 : last;  // the first one that leaves
  const std::vector<std::uint32_t> leaving(chain.begin() + static_cast<std::ptrdiff_t>(cut), chain.end());
  Displacement displacement(flight.simulation(), leaving);
  double most_m = 0;
  Figures out;
  Recorder& recorder = flight.recorder();
  recorder.start();
  const std::uint64_t goal = pilot.op().undock(chain[cut], chain[cut - 1]);
  const auto look = [&] {
    most_m = std::max(most_m, displacement.now_m());
    out.series["time_s"].push_back(flight.simulation().elapsed_s());
    out.series["displacement_m"].push_back(displacement.now_m());
    return is_over(pilot.op().report(goal)->progress);
  };
  pilot.wait_until(look, limit_s);
  const double until_s = flight.simulation().elapsed_s() + after_s;
  while (flight.simulation().elapsed_s() < until_s) {
    pilot.wait(look_s);
    look();
  }
  const FlightFigures f = recorder.figures();
  const bool undocked = pilot.op().report(goal)->progress == GoalProgress::succeeded;
  const bool held = flight.simulation().world().latched_links() + 2 == static_cast<int>(flight.size());
  out.metrics = {{"displacement_m_max", most_m},
                 {"contact_force_N_peak", f.contact_force_N_max},
                 {"joint_torque_Nm_peak", f.joint_torque_Nm_max},
                 {"released", undocked && held ? 1.0 : 0.0}};
  return out;
}

Figures summarise(const std::vector<Figures>& trials) {
  Figures all;
  all.series = trials.front().series;
  const char* const places[] = {"_end", "_middle"};
  all.metrics["released"] = 1;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    for (const auto& [name, value] : trials[k].metrics) {
      if (name == "released") {
        all.metrics[name] = std::min(all.metrics[name], value);
        continue;
      }
      all.metrics[name + places[k]] = value;
      all.metrics[name] = std::max(all.metrics[name], value);
    }
  }
  return all;
}

}  // namespace

const Experiment release_experiment{.name = "release",
                                    .summary = "a chain lets go at its end, and in its middle",
                                    .modules = modules,
                                    .has_trials = false,
                                    .runs = [](const ExperimentConfig&) { return 2u; },
                                    .breaks = {},
                                    .run_trial = &run_trial,
                                    .summarise = &summarise};

}  // namespace eciton::deploy
