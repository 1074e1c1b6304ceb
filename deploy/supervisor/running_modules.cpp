// State files, as JSON.
#include "deploy/supervisor/running_modules.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

namespace eciton::deploy {
namespace {

using Json = nlohmann::json;

RunningModule from_json(const Json& json) {
  RunningModule module{.name = json.at("name"),
                       .holder = json.at("holder"),
                       .module_id = json.at("module_id"),
                       .domain = json.at("domain"),
                       .network_interface = json.at("interface"),
                       .network_namespace = json.at("namespace"),
                       .processes = {},
                       .faults = json.at("faults").get<std::string>()};
  for (const Json& process : json.at("processes")) {
    module.processes.push_back({.name = process.at("name"),
                                .vendor = process.at("vendor"),
                                .pid = process.at("pid"),
                                .restarts = process.at("restarts"),
                                .hangs = process.at("hangs"),
                                .last_end = process.at("last_end")});
  }
  return module;
}

}  // namespace

std::string to_text(const RunningModule& module) {
  Json processes = Json::array();
  for (const RunningProcess& process : module.processes) {
    processes.push_back({{"name", process.name},
                         {"vendor", process.vendor},
                         {"pid", process.pid},
                         {"restarts", process.restarts},
                         {"hangs", process.hangs},
                         {"last_end", process.last_end}});
  }
  const Json json{{"name", module.name},
                  {"holder", module.holder},
                  {"module_id", module.module_id},
                  {"domain", module.domain},
                  {"interface", module.network_interface},
                  {"namespace", module.network_namespace},
                  {"processes", processes},
                  {"faults", module.faults.string()}};
  return json.dump(2) + "\n";
}

std::vector<RunningModule> running_modules(const std::filesystem::path& root) {
  std::vector<RunningModule> modules;
  for (const HeldDirectory& directory : held_directories(root)) {
    std::ifstream file(directory.path / state_file_name);
    const Json json = Json::parse(file, nullptr, false);
    if (json.is_discarded()) continue;
    try {
      modules.push_back(from_json(json));
    } catch (const Json::exception&) {
      continue;  // of another version
    }
  }
  return modules;
}

}  // namespace eciton::deploy
