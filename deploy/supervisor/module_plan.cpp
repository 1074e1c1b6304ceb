// Which programs a module needs, and what no two modules may share.
#include "deploy/supervisor/module_plan.hpp"

#include <set>

#include "core/bus/plugin_loader.hpp"

namespace eciton::deploy {
namespace {

namespace fs = std::filesystem;

PlannedProcess plan_process(const std::string& name, const ModuleConfig& config, const fs::path& program,
                            const fs::path& config_file, const std::vector<std::string>& assignments,
                            const std::vector<std::string>& services) {
  PlannedProcess process{.name = name, .vendor = config.module_participant(name).vendor, .child = {}};
  process.child.name = name;
  process.child.arguments = {program};
  process.child.arguments.insert(process.child.arguments.end(), services.begin(), services.end());
  process.child.arguments.insert(process.child.arguments.end(), {"--config", config_file});
  for (const std::string& assignment : assignments) {
    process.child.arguments.insert(process.child.arguments.end(), {"--set", assignment});
  }
  return process;
}

}  // namespace

LaunchPlan plan_module(const ModuleConfig& config, const fs::path& config_file,
                       const std::vector<std::string>& assignments, const fs::path& programs) {
  LaunchPlan plan{
      .name = config.name,
      .module_id = config.id,
      .domain = config.module_ring.domain,
      .network_interface = config.module_ring.network_interface,
      .claims = {"module id " + std::to_string(config.id), "DDS domain " + std::to_string(config.module_ring.domain)},
      .processes = {},
      .faults = config.recorder.directory};
  // In lockstep nothing hangs on its own: the world waits for the slowest.
  const auto on_wall_clock = [&](double s) { return config.clock == "wall" ? from_s(s) : Duration::zero(); };
  const Duration watchdog = on_wall_clock(config.watchdog_s);
  const Duration hardware_watchdog = on_wall_clock(config.hardware_watchdog_s);
  plan.processes.push_back(
      plan_process("hardware", config, programs / "eciton-hardware", config_file, assignments, {}));
  const std::vector<std::string> all(service_names.begin(), service_names.end());
  for (const std::string& name : config.service_processes()) {
    const bool composed = config.layout == "composed";
    plan.processes.push_back(plan_process(name, config, programs / "eciton-service", config_file, assignments,
                                          composed ? all : std::vector<std::string>{name}));
  }
  for (PlannedProcess& process : plan.processes) {
    process.child.watchdog = process.name == "hardware" ? hardware_watchdog : watchdog;
    // In lockstep nothing is restarted: the world waits for the dead.
    process.has_checkpoints = config.clock == "wall";
    process.records_faults = process.name == "hardware" || process.name == "control" || process.name == "services";
  }
  return plan;
}

Status check_vendors(const std::vector<LaunchPlan>& plans) {
  std::set<std::string> vendors;
  for (const LaunchPlan& plan : plans) {
    for (const PlannedProcess& process : plan.processes) {
      if (!process.vendor.empty()) vendors.insert(process.vendor);
    }
  }
  for (const std::string& vendor : vendors) {
    if (const auto plugin = bus::load_plugin(vendor); !plugin) return plugin.error();
  }
  return ok();
}

Status check_distinct(const std::vector<ModuleConfig>& configs, const std::vector<std::string>& files) {
  for (std::size_t a = 0; a < configs.size(); ++a) {
    for (std::size_t b = a + 1; b < configs.size(); ++b) {
      std::string shared;
      if (configs[a].id == configs[b].id) {
        shared = "id " + std::to_string(configs[a].id);
      } else if (configs[a].name == configs[b].name) {
        shared = "name " + configs[a].name;
      } else if (configs[a].module_ring.domain == configs[b].module_ring.domain) {
        shared = "module_ring.domain " + std::to_string(configs[a].module_ring.domain);
      }
      if (shared.empty()) continue;
      return Error{files[a] + " and " + files[b] + ": both have " + shared + "; every module needs its own"};
    }
  }
  return ok();
}

}  // namespace eciton::deploy
