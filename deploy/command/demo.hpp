// `eciton demo`: modules take off, dock one after another, morph as one body, separate and land: real
// processes over real DDS, flown by the same goals a person would send.
#pragma once

#include "deploy/command/command_line.hpp"

namespace eciton::deploy {

void add_demo(CLI::App& app, Run& run);

}  // namespace eciton::deploy
