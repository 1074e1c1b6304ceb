// Up, together, and to a place.
#include "deploy/experiments/chain_flight.hpp"

#include "core/robot/arrays.hpp"

namespace eciton::deploy {
namespace {

constexpr double settle_s = 6;
constexpr double goto_limit_s = 30;
constexpr double morph_limit_s = 120;

}  // namespace

SimulationConfig row_config(const ExperimentConfig& config, std::uint32_t trial, std::uint32_t modules) {
  SimulationConfig simulated = config.simulation;
  simulated.world.seed = trial_seed(config.seed, trial);
  if (!simulated.world.modules.empty()) return simulated;
  const std::uint32_t count = config.modules > 0 ? config.modules : modules;
  for (std::uint32_t k = 0; k < count; ++k) {
    simulated.world.modules.push_back({.id = k + 1, .p_WB_m = {-row_spacing_m * k, 0, 0}});
  }
  return simulated;
}

ChainFlight::ChainFlight(const ExperimentConfig& config, std::uint32_t trial, std::uint32_t modules)
    : simulation_(std::make_unique<Simulation>(row_config(config, trial, modules))),
      pilot_(std::make_unique<Pilot>(*simulation_)),
      recorder_(std::make_unique<Recorder>(*simulation_)) {}

void ChainFlight::assemble() {
  pilot_->bring_to_hover(std::vector<double>(size(), chain_height_m));
  if (size() > 1) pilot_->zero_leaning();
  pilot_->assemble();
  const robot::Vector3 p_W = robot::vector(pilot_->fleet().find(base())->state->p_WM_m);
  home_.p = {p_W.x(), p_W.y(), chain_height_m};
  pilot_->expect(pilot_->op().go_to(base(), robot::array(home_.p), 0, 0), goto_limit_s);
  recorder_->follow(base(), home_);
  pilot_->wait(settle_s);
}

void ChainFlight::morph(const std::vector<double>& joint_rad, double rate_rad_s) {
  pilot_->expect(pilot_->op().morph(first(), joint_rad, rate_rad_s), morph_limit_s);
}

std::vector<double> ChainFlight::bow(double yaw_rad, double pitch_rad) const {
  // In the order of the chain: the yaw joint of a member and the pitch joint of the next one make a link.
  std::vector<double> joint_rad(2 * size(), 0.0);
  for (std::size_t k = 0; k + 1 < size(); ++k) {
    joint_rad[2 * k] = yaw_rad;
    joint_rad[2 * (k + 1) + 1] = k % 2 == 0 ? pitch_rad : -pitch_rad;
  }
  return joint_rad;
}

}  // namespace eciton::deploy
