// Plain YAML, layered with what --set says, checked by the same readers as a person's files.
#include "deploy/command/demo_fleet.hpp"

#include <sys/un.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "core/bus/plugin_loader.hpp"
#include "deploy/module_config.hpp"
#include "deploy/supervisor/module_plan.hpp"
#include "deploy/world_file.hpp"

namespace eciton::deploy {
namespace {

namespace fs = std::filesystem;
constexpr const char* origin = "--set";
constexpr const char* mixed = "mixed";

std::string key_of(const std::string& assignment) { return assignment.substr(0, assignment.find('=')); }

bool is_any_of(const std::string& key, std::initializer_list<const char*> keys) {
  return std::any_of(keys.begin(), keys.end(), [&](const char* k) { return key == k; });
}

bool is_option(const std::string& key) { return is_any_of(key, {"modules", "dds", "clock", "layout", "seed"}); }

/// Keys of the world may be given by themselves.
bool is_world_short(const std::string& key) {
  return is_any_of(key, {"world", "wakes", "gust_N", "wind_N", "sensing", "noise", "floor", "break"});
}

/// Modules stand in a row along x, the axis along which they link: gaps of a metre and more to begin with.
std::array<double, 3> start_position(std::uint32_t index) {
  constexpr double first_m = 2.2, spacing_m = 1.8;
  return {index == 0 ? 0.0 : first_m + spacing_m * (index - 1), 0.0, 0.0};
}

std::string vendor_of(const DemoOptions& options, std::uint32_t module, std::size_t process) {
  if (options.dds != mixed) return options.dds;
  // Alternates within a module and, process by process, from one module to the next.
  return (module + process) % 2 == 0 ? "cyclonedds" : "fastdds";
}

/// The module's config as assignments, so that a mistake in one of a person's is named as that.
std::vector<std::string> module_assignments(const DemoOptions& options, std::uint32_t index, const fs::path& socket) {
  const std::string id = std::to_string(index + 1);
  std::vector<std::string> all{"id=" + id,
                               "name=m" + id,
                               "layout=" + options.layout,
                               "clock=" + options.clock,
                               "dds=" + vendor_of(options, index, 0),
                               "hal.backend=sim",
                               "hal.socket=" + socket.string()};
  if (options.hosts) all.push_back(std::string("swarm_ring.interface=") + net::radio_interface);
  if (options.dds == mixed) {
    ModuleConfig layout;
    layout.layout = options.layout;
    std::size_t process = 1;  // 0: the hardware host
    for (const std::string& name : layout.service_processes()) {
      all.push_back("vendors." + name + "=" + vendor_of(options, index, process++));
    }
  }
  for (const std::string& assignment : options.assignments) {
    const std::string key = key_of(assignment);
    if (is_world_short(key) || key.starts_with("world.")) continue;
    all.push_back(key == "law" ? "control." + assignment : assignment);
  }
  return all;
}

Result<ConfigTree> world_tree(const DemoOptions& options, const fs::path& socket) {
  std::string text = "socket: " + socket.string() + "\npace: " + options.clock +
                     "\ntick_s: 0.002\ntruth: true\ndds: " + (options.dds == mixed ? "cyclonedds" : options.dds) +
                     (options.hosts ? "\nnet: " + options.net : std::string()) +
                     "\nworld:\n  seed: " + std::to_string(options.seed) + "\n  modules:\n";
  for (std::uint32_t index = 0; index < options.modules; ++index) {
    const auto p = start_position(index);
    char line[96];
    std::snprintf(line, sizeof line, "    - {id: %u, position_m: [%.3f, %.3f, %.3f]}\n", index + 1, p[0], p[1], p[2]);
    text += line;
  }
  ConfigTree tree;
  if (const Status status = tree.add_text(text, "world"); !status) return status.error();
  for (const std::string& assignment : options.assignments) {
    const std::string key = key_of(assignment);
    const bool is_short = is_world_short(key);
    if (!is_short && !key.starts_with("world.")) continue;
    if (const Status status = tree.set(is_short ? "world." + assignment : assignment, origin); !status) {
      return status.error();
    }
  }
  return tree;
}

/// Of children, so that the config's vendors hold even where ECITON_DDS is set.
void pin_vendors(LaunchPlan& plan) {
  for (PlannedProcess& process : plan.processes) process.child.environment = {{"ECITON_DDS", ""}};
}

Status add_world(const DemoOptions& options, const fs::path& programs, const fs::path& directory, DemoFleet& fleet) {
  const fs::path socket = directory / "world.sock";
  if (socket.string().size() >= sizeof(sockaddr_un::sun_path)) {
    return Error{"socket " + socket.string() + ": the path is longer than " +
                 std::to_string(sizeof(sockaddr_un::sun_path) - 1) +
                 " characters; set ECITON_RUNTIME_DIR to a shorter one"};
  }
  const Result<ConfigTree> tree = world_tree(options, socket);
  if (!tree) return tree.error();
  WorldFile world;
  if (const Status status = read_config(*tree, world); !status) return status.error();
  const fs::path file = directory / "world.yaml";
  fleet.files.push_back({file, tree->to_yaml()});
  LaunchPlan plan{.name = directory.filename(), .network_interface = {}, .claims = {}, .processes = {}};
  plan.processes.push_back({.name = "world", .vendor = world.dds, .child = {}});
  plan.processes[0].child = {.name = "world", .arguments = {programs / "eciton-world", "--config", file}};
  fleet.plans.push_back(std::move(plan));
  return ok();
}

/// Ids and domains are taken in that net only.
void move_to_host(LaunchPlan& plan, const std::string& net) {
  plan.network_namespace = net::host_namespace(net, plan.module_id);
  for (PlannedProcess& process : plan.processes) process.child.network_namespace = plan.network_namespace;
  for (std::string& claim : plan.claims) claim += " of net " + net;
}

/// The net that is up is used as it is; else there is one for this flight.
Status add_net(const DemoOptions& options, const fs::path& programs, const std::optional<net::NetSpec>& running,
               DemoFleet& fleet) {
  fleet.swarm_namespace = net::host_namespace(options.net, net::operator_host);
  if (running) {
    if (running->modules >= options.modules) return ok();
    return Error{"net " + options.net + " is up with " + std::to_string(running->modules) + " module hosts, " +
                 std::to_string(options.modules) + " are needed; end it with 'eciton net down --name " + options.net +
                 "', or give this demo another --net"};
  }
  fleet.own_net = net::NetSpec{.name = options.net, .modules = options.modules, .seed = options.seed};
  LaunchPlan plan{.name = "net", .network_interface = {}, .claims = {}, .processes = {}};
  plan.processes.push_back({.name = "relay", .vendor = {}, .child = {}});
  plan.processes[0].child = {.name = "relay", .arguments = net::relay_call(*fleet.own_net, programs)};
  fleet.plans.push_back(std::move(plan));
  return ok();
}

Status add_module(const DemoOptions& options, std::uint32_t index, const fs::path& programs,
                  const fs::path& directory, DemoFleet& fleet) {
  const std::vector<std::string> assignments = module_assignments(options, index, directory / "world.sock");
  const Result<ModuleConfig> config = load_module_config({}, assignments);
  if (!config) return config.error();
  ConfigTree tree;
  for (const std::string& assignment : assignments) ok_or_throw(tree.set(assignment, origin));
  const fs::path file = directory / (config->name + ".yaml");
  fleet.files.push_back({file, tree.to_yaml()});
  fleet.plans.push_back(plan_module(*config, file, {}, programs));
  if (options.hosts) move_to_host(fleet.plans.back(), options.net);
  fleet.start_m.push_back(start_position(index));
  fleet.swarm_domain = config->swarm_ring.domain;
  fleet.swarm_interface = config->swarm_ring.network_interface;
  return ok();
}

}  // namespace

Result<DemoOptions> resolve(DemoOptions options) {
  ConfigTree tree;
  std::vector<std::string> rest;
  for (const std::string& assignment : options.assignments) {
    if (!is_option(key_of(assignment))) {
      rest.push_back(assignment);
    } else if (const Status status = tree.set(assignment, origin); !status) {
      return status.error();
    }
  }
  options.assignments = rest;
  if (const Status status = read_config(tree, options); !status) return status.error();
  if (options.dds.empty()) options.dds = bus::chosen_vendor("cyclonedds");
  if (options.hosts && options.clock == "lockstep") {
    return Error{"--clock lockstep with --hosts: the flight would wait for whatever the radio delays; expected wall"};
  }
  if (options.clock.empty()) options.clock = options.hosts ? "wall" : "lockstep";
  if (options.layout.empty()) options.layout = options.hosts ? "composed" : "services";
  if (const Status named = net::check_name(options.net); !named) return Error{"--net: " + named.error().message};
  return options;
}

Result<DemoFleet> plan_demo(const DemoOptions& options, const fs::path& programs, const fs::path& root,
                            const std::optional<net::NetSpec>& running) {
  DemoFleet fleet;
  const fs::path directory = root / "demo";
  fleet.tool_vendor = options.dds == mixed ? "cyclonedds" : options.dds;
  if (const Status status = add_world(options, programs, directory, fleet); !status) return status.error();
  for (std::uint32_t index = 0; index < options.modules; ++index) {
    if (const Status status = add_module(options, index, programs, directory, fleet); !status) return status.error();
  }
  if (options.hosts) {
    if (const Status status = add_net(options, programs, running, fleet); !status) return status.error();
  }
  for (LaunchPlan& plan : fleet.plans) pin_vendors(plan);
  return fleet;
}

}  // namespace eciton::deploy
