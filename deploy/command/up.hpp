// `eciton up`: runs the processes of modules, and a simulated world for them, until told to end.
#pragma once

#include "deploy/command/command_line.hpp"

namespace eciton::deploy {

void add_up(CLI::App& app, Run& run);

}  // namespace eciton::deploy
