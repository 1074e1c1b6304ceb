// `eciton down`: ends modules that `eciton up` runs.
#pragma once

#include "deploy/command/command_line.hpp"

namespace eciton::deploy {

void add_down(CLI::App& app, Run& run);

}  // namespace eciton::deploy
