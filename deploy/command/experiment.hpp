// `eciton experiment NAME`: one deterministic run of the simulated system, and its figures.
#pragma once

#include "deploy/command/command_line.hpp"

namespace eciton::deploy {

void add_experiment(CLI::App& app, Run& run);

}  // namespace eciton::deploy
