// Runs every hot workload in turn for callgrind, which collects inside one function and dumps whenever it is
// left (benchmarks/gate/run says how); writes into FILE what built it and which dump is whose.
// Usage: eciton-bench-hot-path FILE
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "benchmarks/micro/workload.hpp"
#include "core/base/result.hpp"

namespace {

constexpr int steps_counted = 100;
volatile double outcome;

}  // namespace

/// Callgrind finds it by its name.
extern "C" [[gnu::noinline]] void eciton_counted_steps(const eciton::bench::Step& step) {
  for (int k = 0; k < steps_counted; ++k) outcome = step();
}

namespace {

int run(const char* path) {
  std::ofstream file(path);
  if (!file) throw eciton::BadInput{{std::string(path) + ": cannot be written: " + std::strerror(errno)}};
  file << ECITON_BUILT_WITH << "\n" << steps_counted << "\n";
  eciton::bench::find_mirror_plugin();
  for (const eciton::bench::Workload& workload : eciton::bench::all_workloads()) {
    if (!workload.hot) continue;
    const eciton::bench::Step step = workload.make();
    for (int k = 0; k < 20; ++k) outcome = step();  // what is done once only
    eciton_counted_steps(step);
    file << workload.name << "\n";
  }
  file.flush();
  return file ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "Usage: eciton-bench-hot-path FILE\n");
    return 2;
  }
  try {
    return run(argv[1]);
  } catch (const eciton::BadInput& bad) {
    std::fprintf(stderr, "eciton-bench-hot-path: %s\n", bad.error.message.c_str());
    return 2;
  }
}
