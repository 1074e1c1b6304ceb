// Modules that exchange places in separated flight, all at once.
#pragma once

#include <vector>

#include "core/robot/frames.hpp"
#include "deploy/experiments/experiment.hpp"

namespace eciton::deploy {

struct Crossing {
  std::vector<robot::Vector3> starts_W;  // one a module, at flying height
  std::vector<robot::Vector3> goals_W;
  std::vector<double> speed_m_s;
  double limit_s = 60;
};

/// Flies it in this process; figures as of the experiment.
Figures fly_crossing(const ExperimentConfig& config, std::uint64_t seed, const Crossing& crossing);

}  // namespace eciton::deploy
