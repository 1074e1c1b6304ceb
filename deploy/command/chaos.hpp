// `eciton chaos`: kills, stops and cuts off what flies, over emulated hosts and on the wall clock, and holds what
// happens against bounds.
#pragma once

#include "deploy/command/command_line.hpp"

namespace eciton::deploy {

void add_chaos(CLI::App& app, Run& run);

}  // namespace eciton::deploy
