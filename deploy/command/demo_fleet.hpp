// The processes of a demo: configs of the modules and of their world, written into a fresh runtime directory.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/config.hpp"
#include "deploy/net/net.hpp"
#include "deploy/supervisor/launch_loop.hpp"

namespace eciton::deploy {

struct DemoOptions {
  std::uint32_t modules = 3;
  std::string dds{};     // cyclonedds, fastdds, mixed; empty: ECITON_DDS, or Cyclone DDS
  std::string clock{};   // lockstep or wall; empty: lockstep, wall with hosts
  std::string layout{};  // services or composed; empty: services, composed with hosts
  std::uint64_t seed = 1;
  bool hosts = false;  // every module in a host of its own, on the radio of `net`
  std::string net = net::default_name;
  std::vector<std::string> assignments{};  // of the modules' and the world's keys
  std::string keep_logs{};
  std::string json_file{};

  template <class V>
  void visit_fields(V& v) {
    v("modules", modules, in_range(2, 8));
    v("dds", dds, one_of({"", "cyclonedds", "fastdds", "mixed"}));
    v("clock", clock, one_of({"", "lockstep", "wall"}));
    v("layout", layout, one_of({"", "services", "composed"}));
    v("seed", seed);
  }
};

struct DemoFile {
  std::filesystem::path path;
  std::string text;
};

struct DemoFleet {
  std::vector<LaunchPlan> plans;               // the world's first; with a net of its own, the relay's last
  std::vector<DemoFile> files;                 // to be written once the directories are held
  std::vector<std::array<double, 3>> start_m;  // where each module starts, by index
  std::string tool_vendor;                     // of the demo's own participants
  std::uint32_t swarm_domain = 1;
  std::string swarm_interface = "lo";
  std::filesystem::path swarm_namespace{};  // where the demo itself joins the swarm ring; empty: here
  std::optional<net::NetSpec> own_net{};    // that comes and goes with this demo
};

/// Options that came as --set (modules, dds, clock, layout, seed) go to where they belong.
Result<DemoOptions> resolve(DemoOptions options);

/// Checks everything and touches nothing. `programs`: where eciton-world and the others are.
/// `running`: the net that is up already, if there is one of the name asked for.
Result<DemoFleet> plan_demo(const DemoOptions& options, const std::filesystem::path& programs,
                            const std::filesystem::path& root, const std::optional<net::NetSpec>& running = {});

}  // namespace eciton::deploy
