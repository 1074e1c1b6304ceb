// Times every workload with Google Benchmark, whose options it takes; counts the hot ones' uses of the heap.
#include <benchmark/benchmark.h>

#include <cstdio>

#include "benchmarks/micro/workload.hpp"
#include "core/base/result.hpp"
#include "tests/allocation_guard/allocation_guard.hpp"

namespace {

using eciton::bench::Step;
using eciton::bench::Workload;

double uses_of_the_heap(const Step& step) {
  constexpr int times = 100;
  double sum = 0;
  eciton::testing::AllocationGuard guard;
  for (int k = 0; k < times; ++k) sum += step();
  benchmark::DoNotOptimize(sum);
  return static_cast<double>(guard.framework() + guard.vendor()) / times;
}

void run_workload(benchmark::State& state, const Workload& workload) {
  const Step step = workload.make();
  for (auto _ : state) {
    double outcome = step();
    benchmark::DoNotOptimize(outcome);
  }
  if (workload.hot && eciton::testing::AllocationGuard::available()) {
    state.counters["heap_uses"] = uses_of_the_heap(step);
  }
}

int run(int argc, char** argv) {
  eciton::bench::find_mirror_plugin();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("built_with", ECITON_BUILT_WITH);
  for (const Workload& workload : eciton::bench::all_workloads()) {
    benchmark::RegisterBenchmark(workload.name.c_str(), run_workload, workload);
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const eciton::BadInput& bad) {
    std::fprintf(stderr, "eciton-bench-micro: %s\n", bad.error.message.c_str());
    return 2;
  }
}
