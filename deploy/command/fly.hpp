// The verbs that fly: `eciton arm | disarm | takeoff | goto | dock | morph | undock | land | stop`.
#pragma once

#include "deploy/command/command_line.hpp"

namespace eciton::deploy {

void add_fly(CLI::App& app, Run& run);

}  // namespace eciton::deploy
