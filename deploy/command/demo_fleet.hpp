// The processes of a demo: configs of the modules and of their world, written into a fresh runtime directory.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/config.hpp"
#include "deploy/supervisor/launch_loop.hpp"

namespace eciton::deploy {

struct DemoOptions {
  std::uint32_t modules = 3;
  std::string dds{};                // cyclonedds, fastdds, mixed; empty: ECITON_DDS, or Cyclone DDS
  std::string clock = "lockstep";   // or wall
  std::string layout = "services";  // or composed
  std::uint64_t seed = 1;
  std::vector<std::string> assignments{};  // of the modules' and the world's keys
  std::string keep_logs{};
  std::string json_file{};

  template <class V>
  void visit_fields(V& v) {
    v("modules", modules, in_range(2, 8));
    v("dds", dds, one_of({"", "cyclonedds", "fastdds", "mixed"}));
    v("clock", clock, one_of({"lockstep", "wall"}));
    v("layout", layout, one_of({"services", "composed"}));
    v("seed", seed);
  }
};

struct DemoFile {
  std::filesystem::path path;
  std::string text;
};

struct DemoFleet {
  std::vector<LaunchPlan> plans;               // the world's first
  std::vector<DemoFile> files;                 // to be written once the directories are held
  std::vector<std::array<double, 3>> start_m;  // where each module starts, by index
  std::string tool_vendor;                     // of the demo's own participants
  std::uint32_t swarm_domain = 1;
  std::string swarm_interface = "lo";
};

/// Options that came as --set (modules, dds, clock, layout, seed) go to where they belong.
Result<DemoOptions> resolve(DemoOptions options);

/// Checks everything and touches nothing. `programs`: where eciton-world and the others are.
Result<DemoFleet> plan_demo(const DemoOptions& options, const std::filesystem::path& programs,
                            const std::filesystem::path& root);

}  // namespace eciton::deploy
