// From options to a participant's config.
#include "deploy/command/ring_options.hpp"

#include "core/bus/plugin_loader.hpp"

namespace eciton::deploy {
namespace {

constexpr std::uint32_t module_ring_domain_base = 10;
constexpr std::uint32_t swarm_ring_domain = 1;

}  // namespace

void add_ring_options(CLI::App& app, RingOptions& options) {
  auto* module =
      app.add_option("--module", options.module_id, "join this module's ring (default: 1)")->check(CLI::Range(1, 90));
  auto* swarm = app.add_flag("--swarm", options.swarm, "join the swarm ring");
  auto* domain = app.add_option("--domain", options.domain, "join this DDS domain")->check(CLI::Range(0, 232));
  module->excludes(swarm)->excludes(domain);
  swarm->excludes(domain);
  app.add_option("--dds", options.vendor, "DDS vendor: cyclonedds or fastdds (default: ECITON_DDS, else cyclonedds)");
  app.add_option("--interface", options.network_interface, "network interface (default: lo)");
}

bus::ParticipantConfig participant_config(const RingOptions& options, const std::string& tool) {
  bus::ParticipantConfig config;
  config.vendor = options.vendor.empty() ? bus::chosen_vendor("cyclonedds") : options.vendor;
  config.domain = options.domain != RingOptions::no_domain ? options.domain
                  : options.swarm                          ? swarm_ring_domain
                                                           : module_ring_domain_base + options.module_id;
  config.name = tool;
  config.network_interface = options.network_interface;
  return config;
}

std::string describe(const RingOptions& options, const bus::ParticipantConfig& config) {
  const std::string where =
      "domain " + std::to_string(config.domain) + " on " + config.network_interface + ", " + config.vendor;
  if (options.domain != RingOptions::no_domain) return where;
  if (options.swarm) return "the swarm ring (" + where + ")";
  return "module " + std::to_string(options.module_id) + "'s ring (" + where + ")";
}

}  // namespace eciton::deploy
