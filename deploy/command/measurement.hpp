// The JSON object that every measuring command writes with --json FILE:
// {"command", "config", "seed", "clock", "metrics": {flat name: number}, "series": {...}}.
#pragma once

#include <string>

#include "core/base/result.hpp"
#include "deploy/command/message_json.hpp"

namespace eciton::deploy {

struct Measurement {
  std::string command;
  std::string clock;             // monotonic, wall or simulated
  Json config = Json::object();  // what decided the figures
  Json seed = nullptr;           // nothing random
  Json metrics = Json::object();
  Json series = Json::object();
};

/// Before the work that is to be measured: whether its result can be kept. An empty path: nothing is asked for.
Status check_measurement_file(const std::string& path);

/// The Error names the file and why it cannot be written.
Status write_measurement(const std::string& path, const Measurement& measurement);

}  // namespace eciton::deploy
