// `bench path`: how long an IMU sample takes to become a rotor command, stage by stage, and how old the data is
// that is acted on: through the real programs as processes, composed, and all in one process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/path/progress.hpp"
#include "benchmarks/report/result.hpp"

namespace eciton::bench {

struct PathOptions {
  std::vector<std::string> vendors{"cyclonedds"};
  /// services: a process each; composed: the services in one; one-process: the hardware host too.
  std::vector<std::string> layouts{"services", "composed", "one-process"};
  double seconds = 20;        // of hovering flight, measured, per round
  std::size_t rounds = 1;     // of all of them, forward and backward in turn
  bool whole_module = false;  // docking, joints and radio run too, where they have processes of their own
  int realtime_priority = 0;  // SCHED_FIFO of the services' threads; 0: as the system schedules them
  std::uint32_t module_id = 88;
  std::uint64_t seed = 1;                // of the world
  std::vector<std::string> assignments;  // key=value, of the module's config
  std::filesystem::path programs;        // where eciton-world and the others are
};

/// Flies the simulated module and measures. Throws BadInput before anything starts when something that is asked for
/// cannot be had; what fails later is in the result's notes, and marks it as partial.
Result run_path(const PathOptions& options, const runtime::StopFlag& stop, const Progress& progress);

}  // namespace eciton::bench
