// What the experiments on chains share: a row of modules that takes off, docks one by one in the air and stands as
// one body at a known place, watched by a recorder.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "deploy/experiments/pilot.hpp"
#include "deploy/experiments/recorder.hpp"

namespace eciton::deploy {

inline constexpr double chain_height_m = 1.5;
inline constexpr double row_spacing_m = 1.9;  // 1.1 m between two modules' docking points

/// The experiment's simulation, its modules in a row along x unless the config places them.
SimulationConfig row_config(const ExperimentConfig& config, std::uint32_t trial, std::uint32_t modules);

class ChainFlight {
 public:
  /// `config.modules` modules, or `modules` when the config does not say.
  ChainFlight(const ExperimentConfig& config, std::uint32_t trial, std::uint32_t modules);

  /// To the chain that hovers with its base at `home()`, straight and settled. One module alone hovers there.
  void assemble();
  /// Morphs, and waits until it is done. Throws std::runtime_error when it is refused or aborted.
  void morph(const std::vector<double>& joint_rad, double rate_rad_s = 0);
  /// Joint angles for a chain of this length with the same yaw and pitch in every link; pitch by turns.
  std::vector<double> bow(double yaw_rad, double pitch_rad) const;

  Simulation& simulation() { return *simulation_; }
  Pilot& pilot() { return *pilot_; }
  Recorder& recorder() { return *recorder_; }
  std::size_t size() const { return simulation_->size(); }
  std::uint32_t first() const { return simulation_->id(0); }
  std::uint32_t base() const { return pilot_->base(first()); }
  const robot::Pose& home() const { return home_; }

 private:
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<Pilot> pilot_;
  std::unique_ptr<Recorder> recorder_;
  robot::Pose home_;
};

}  // namespace eciton::deploy
