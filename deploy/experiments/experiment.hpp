// An experiment: one deterministic run of the whole simulated system for a seed, and the figures it gives.
// Metrics without a suffix are the physics' truth, ..._estimated what the services believed.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "deploy/report/plot.hpp"
#include "deploy/simulation.hpp"

namespace eciton::deploy {

/// Of the docking experiment: how many modules each side has, already a chain when the clock starts.
struct DockingSides {
  std::uint32_t follower_modules = 1;
  std::uint32_t target_modules = 1;

  template <class V>
  void visit_fields(V& v) {
    v("follower_modules", follower_modules, in_range(1, 8));
    v("target_modules", target_modules, in_range(1, 8));
  }
};

struct ExperimentConfig {
  std::uint64_t seed = 1;
  std::uint32_t trials = 1;
  std::uint32_t modules = 0;  // 0: as many as the experiment needs
  std::string break_what;     // a control that must fail
  bool paper_grid = true;     // scaling: the paper's law too, at each setting of a grid
  DockingSides docking;
  SimulationConfig simulation;

  template <class V>
  void visit_fields(V& v) {
    v("modules", modules, in_range(0, 16));
    v("paper_grid", paper_grid);
    v("docking", docking);
    v("world", simulation.world);
    v("radio_link", simulation.radio_link);
    v("module", simulation.module);
  }
};

/// A moment of the flight, to be drawn after it: where everything was.
struct Still {
  std::string title;
  double time_s = 0;
  std::vector<double> posture;  // World::posture()
};

/// Flat names and series of one trial, or of all.
struct Figures {
  std::map<std::string, double> metrics;
  std::map<std::string, std::vector<double>> series;
  std::vector<Still> stills;
};

struct Experiment {
  std::string name;
  std::string summary;
  std::uint32_t modules;  // when the config does not say
  bool has_trials;
  /// Without --trials: how many runs it consists of; empty: one.
  std::uint32_t (*runs)(const ExperimentConfig& config) = nullptr;
  std::vector<std::string> breaks;  // what --break understands
  Figures (*run_trial)(const ExperimentConfig& config, std::uint32_t trial);
  /// From all trials' figures, in their order.
  Figures (*summarise)(const std::vector<Figures>& trials);
  /// The paper's own plots, from the summary's series; none: every series over time_s, by its unit.
  std::vector<report::Plot> (*plots)(const Figures& figures) = nullptr;
};

/// For an experiment that is one trial.
Figures only_trial(const std::vector<Figures>& trials);

const std::vector<Experiment>& experiments();
extern const Experiment hover_experiment;
extern const Experiment docking_experiment;
extern const Experiment tracking_experiment;
extern const Experiment morph_experiment;
extern const Experiment ablation_experiment;
extern const Experiment scaling_experiment;
extern const Experiment wind_experiment;
extern const Experiment release_experiment;
extern const Experiment silence_experiment;
extern const Experiment crossing_experiment;
extern const Experiment forest_experiment;

/// What it is made of: trials as the config says, or the experiment's own runs.
std::uint32_t trials_of(const Experiment& experiment, const ExperimentConfig& config);

/// Runs the trials in so many processes; the figures do not depend on how many. `progress` is called with the
/// number of finished trials. Throws BadInput, or std::runtime_error when a trial broke down.
Figures run_experiment(const Experiment& experiment, const ExperimentConfig& config, std::uint32_t jobs,
                       const std::function<void(std::uint32_t)>& progress);

/// The seed of one trial of a run: trials are independent and can be replayed alone.
std::uint64_t trial_seed(std::uint64_t seed, std::uint32_t trial);

}  // namespace eciton::deploy
