// `eciton net up | set | show | down`: module hosts on this machine, and a radio between them that is as bad as
// asked.
#pragma once

#include "deploy/command/command_line.hpp"

namespace eciton::deploy {

void add_net(CLI::App& app, Run& run);

}  // namespace eciton::deploy
