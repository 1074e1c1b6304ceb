// `eciton status`: what runs on this host and how it is doing, from heartbeats and states on the module rings.
#pragma once

#include "deploy/command/command_line.hpp"

namespace eciton::deploy {

void add_status(CLI::App& app, Run& run);

}  // namespace eciton::deploy
