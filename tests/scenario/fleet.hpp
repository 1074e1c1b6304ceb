// A small fleet in the air, for scenarios.
#pragma once

#include "deploy/experiments/pilot.hpp"

namespace eciton::deploy {

/// Modules 1..n in a row along x, male ports towards the next lower one's female side.
inline SimulationConfig row_of(std::uint32_t modules, std::uint64_t seed) {
  SimulationConfig config;
  config.world.seed = seed;
  for (std::uint32_t k = 0; k < modules; ++k) {
    config.world.modules.push_back({.id = k + 1, .p_WB_m = {-2.2 * k, 0.2 * k, 0}});
  }
  return config;
}

inline std::vector<double> heights(std::uint32_t modules) { return std::vector<double>(modules, 1.5); }

inline bool in_one_chain(const Pilot& pilot, std::uint32_t modules) {
  for (std::uint32_t id = 1; id <= modules; ++id) {
    const KnownModule* m = pilot.fleet().find(id);
    if (m == nullptr || !m->in_chain() || m->view->members.size() != modules) return false;
    if (m->view->active_epoch != pilot.fleet().find(1)->view->active_epoch) return false;
  }
  return true;
}

}  // namespace eciton::deploy
