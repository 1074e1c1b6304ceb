// How every program of Eciton starts and ends: bad input is one line on standard error and exit status 2.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace eciton::deploy {

/// Runs `body` and turns BadInput into exit status 2, anything else thrown into 1.
int run_program(const std::string& name, const std::function<int()>& body);

/// What `eciton-hardware`, `eciton-service` and `eciton-world` understand.
struct ProgramOptions {
  std::vector<std::string> config_files;
  std::vector<std::string> assignments;  // --set key=value
  std::string log_level = "info";
  std::vector<std::string> names;  // services to run
  std::string checkpoints;         // directory of their checkpoints; empty: none
  std::string faults;              // directory of their fault records; empty: none
};

/// What not all of them understand.
struct ProgramTakes {
  bool names = false;
  bool checkpoints = false;
  bool faults = false;
};

/// Throws BadInput; prints help and exits with 0 when asked for it.
ProgramOptions parse_options(int argc, char** argv, const std::string& purpose, const ProgramTakes& takes = {});

}  // namespace eciton::deploy
