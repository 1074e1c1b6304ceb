// `bench formation`: from a latch to the chain that all members fly by, and what it costs on the air that modules
// find each other.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/path/progress.hpp"
#include "benchmarks/report/result.hpp"

namespace eciton::bench {

/// Members alternate between the two.
struct VendorPair {
  std::string first, second;
  std::string name() const { return first + "+" + second; }
};

struct FormationOptions {
  std::vector<std::uint32_t> modules{2, 3, 4, 5, 6, 7, 8};
  std::vector<double> losses{0, 0.1, 0.2};  // of every directed link
  /// Every pair with `pairs_at` modules, the first alone with other numbers.
  std::vector<VendorPair> pairs{
      {"cyclonedds", "cyclonedds"}, {"fastdds", "fastdds"}, {"cyclonedds", "fastdds"}, {"fastdds", "cyclonedds"}};
  std::uint32_t pairs_at = 3;
  std::size_t trials = 60;   // of each
  std::size_t sessions = 3;  // in which they are made: members start anew, at other phases of their periods
  bool form = true;
  int realtime_priority = 0;  // SCHED_FIFO of the members' services; 0: as the system schedules them

  bool discover = true;
  std::vector<std::uint32_t> discovery_modules{2, 4, 8, 16};
  std::vector<std::string> discovery_vendors{"cyclonedds", "fastdds"};
  double idle_s = 30;    // listened to when all have met
  double joining_s = 8;  // listened to from the start of the last one
  double settle_s = 12;  // before that, from the start of the others

  /// false: over loopback, where nothing is lost and discovery is not what it is between hosts.
  bool hosts = true;
  std::string net = "eciton-bench";
  std::uint64_t seed = 1;                // of the radio and of when a latch catches
  std::vector<std::string> assignments;  // key=value, of the modules' configs
  std::filesystem::path programs;
};

/// Throws BadInput before anything starts when a right or a program is missing.
Result run_formation(const FormationOptions& options, const runtime::StopFlag& stop, const Progress& progress);

}  // namespace eciton::bench
