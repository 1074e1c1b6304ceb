// Reads and completes a module's config.
#include "deploy/module_config.hpp"

#include <algorithm>

#include "core/bus/plugin_loader.hpp"

namespace eciton::deploy {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

Status check_vendors(const ModuleConfig& config) {
  std::vector<std::string> processes = config.service_processes();
  processes.emplace_back("hardware");
  for (const auto& [process, vendor] : config.vendors) {
    if (std::find(processes.begin(), processes.end(), process) == processes.end()) {
      return Error{"vendors." + process + ": no process of this module (layout " + config.layout +
                   "); expected one of " + joined(processes)};
    }
  }
  return ok();
}

/// Where every step waits for a tick of the world, 10 ms are often enough; on the wall clock a chain's agreement
/// passes through six such waits (measured: latch to first shared wrench 175 ms at 10 ms, 70 ms at these).
void set_wall_pace(ModuleConfig& config) {
  config.radio.period_s = 0.002;
  config.docking.rate_Hz = 500;
  config.docking.start_margin_s = 0.05;
  config.radio.watches = config.docking.watches = true;
}

}  // namespace

std::vector<std::string> ModuleConfig::service_processes() const {
  if (layout == "composed") return {"services"};
  return {service_names.begin(), service_names.end()};
}

bus::ParticipantConfig ModuleConfig::module_participant(const std::string& process) const {
  const auto own = vendors.find(process);
  return {.vendor = bus::chosen_vendor(own != vendors.end() ? own->second : dds),
          .domain = module_ring.domain,
          .name = name + "/" + process,
          .network_interface = module_ring.network_interface,
          .peers = module_ring.peers,
          .lease = from_s(lease_s)};
}

bus::ParticipantConfig ModuleConfig::swarm_participant(const std::string& process) const {
  bus::ParticipantConfig participant = module_participant(process);
  participant.domain = swarm_ring.domain;
  participant.network_interface = swarm_ring.network_interface;
  participant.peers = swarm_ring.peers;
  return participant;
}

void set_identity(ModuleConfig& config) {
  config.estimation.module_id = config.id;
  config.control.module_id = config.id;
  config.control.observer_gain_1_s = config.estimation.observer_gain_1_s;
  config.control.recorder = config.recorder;
  config.docking.module_id = config.id;
  config.joints.module_id = config.id;
  config.radio.module_id = config.id;
  config.radio.name = config.name;
  config.radio.airframe = config.airframe;
  config.radio.ports = static_cast<std::uint32_t>(robot::legion(config.airframe == "legion-lidar").ports.size());
}

void set_fault_directory(ModuleConfig& config, const std::string& directory) {
  if (config.recorder.directory.empty()) config.recorder.directory = directory;
  config.control.recorder = config.recorder;
}

Result<ModuleConfig> load_module_config(const std::vector<std::string>& files,
                                        const std::vector<std::string>& assignments) {
  ConfigTree tree;
  for (const std::string& file : files) {
    if (const Status status = tree.add_file(file); !status) return status.error();
  }
  for (const std::string& assignment : assignments) {
    if (const Status status = tree.set(assignment, "--set"); !status) return status.error();
  }
  ModuleConfig config;
  if (const Status status = read_config(tree, config); !status) return status.error();
  if (config.clock == "wall") {
    config = {};
    set_wall_pace(config);
    if (const Status status = read_config(tree, config); !status) return status.error();
  }
  if (config.id == 0) return Error{joined(files) + ": id is missing; expected a whole number from 1 to 90"};
  if (config.name.empty()) config.name = "m" + std::to_string(config.id);
  if (config.module_ring.domain == 0) config.module_ring.domain = module_ring_domain(config.id);
  if (config.module_ring.domain == config.swarm_ring.domain) {
    return Error{joined(files) + ": module_ring.domain and swarm_ring.domain are both " +
                 std::to_string(config.swarm_ring.domain) + "; the two rings need different domains"};
  }
  if (const Status status = check_vendors(config); !status) return status.error();
  set_identity(config);
  return config;
}

}  // namespace eciton::deploy
