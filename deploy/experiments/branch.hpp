// Goes on from the present state of a simulation in a process of its own, and comes back: what is tried there leaves
// no trace here.
#pragma once

#include <functional>

#include "deploy/experiments/experiment.hpp"

namespace eciton::deploy {

/// The figures of `run`, which runs in a copy of this process. Throws std::runtime_error when it broke down.
Figures in_a_branch(const std::function<Figures()>& run);

}  // namespace eciton::deploy
