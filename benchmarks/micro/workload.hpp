// The pieces of code whose cost is watched, as things that can be run again and again: timed by Google
// Benchmark (eciton-bench-micro), their instructions counted under callgrind (eciton-bench-hot-path).
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace eciton::bench {

/// Does the work once. What it returns depends on the work's outcome, so that no compiler leaves it out.
using Step = std::function<double()>;

struct Workload {
  std::string name;  // "codec/encode/module_state"
  std::function<Step()> make;
  bool hot = false;  // on a path of flight: its instructions are gated, and it leaves the heap alone
};

std::vector<Workload> codec_workloads();
std::vector<Workload> delivery_workloads();
std::vector<Workload> maths_workloads();
std::vector<Workload> contact_workloads();
std::vector<Workload> control_workloads();
std::vector<Workload> chain_workloads();

/// All of the above, each name once.
std::vector<Workload> all_workloads();

/// Before the first workload is made: where the plugin that only mirrors samples is.
void find_mirror_plugin();

}  // namespace eciton::bench
