// Which ring a tool joins, over which vendor: the options that all tools share.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "core/bus/participant.hpp"

namespace eciton::deploy {

struct RingOptions {
  std::uint32_t module_id = 1;
  bool swarm = false;
  std::uint32_t domain = no_domain;  // over the two above
  std::string vendor;                // empty: ECITON_DDS, or Cyclone DDS
  std::string network_interface = "lo";

  static constexpr std::uint32_t no_domain = 0xffffffff;
};

/// --module, --swarm, --domain, --dds and --interface.
void add_ring_options(CLI::App& app, RingOptions& options);

/// `tool` names the participant to foreign tools.
bus::ParticipantConfig participant_config(const RingOptions& options, const std::string& tool);

/// "module 3's ring (domain 13 on lo, cyclonedds)"
std::string describe(const RingOptions& options, const bus::ParticipantConfig& config);

}  // namespace eciton::deploy
