// Puts the lists together.
#include "benchmarks/micro/workload.hpp"

#include <cstdlib>
#include <iterator>

namespace eciton::bench {

std::vector<Workload> all_workloads() {
  std::vector<Workload> all;
  for (const auto list : {codec_workloads, delivery_workloads, maths_workloads, contact_workloads, control_workloads,
                          chain_workloads}) {
    std::vector<Workload> some = list();
    all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
  }
  return all;
}

void find_mirror_plugin() {
  // Apart from the vendors' plugins: nobody flies on it.
  ::setenv("ECITON_PLUGIN_PATH", ECITON_MIRROR_PLUGIN_PATH, 1);
}

}  // namespace eciton::bench
