// Times every workload with Google Benchmark, whose options it takes, and --json FILE, --html FILE; counts the hot
// ones' uses of the heap.
#include <benchmark/benchmark.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "benchmarks/micro/micro_report.hpp"
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
  benchmark::Initialize(&argc, argv);  // takes its own options out
  CLI::App app("Times the steps of flight, piece by piece", "eciton-bench-micro");
  eciton::bench::ReportFiles files;
  app.add_option("--json", files.json, "file for the figures");
  app.add_option("--html", files.html, "file for one self-contained page");
  app.footer("And the options of Google Benchmark: --benchmark_filter, --benchmark_repetitions, ...");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  ok_or_throw(check_report_files(files));
  eciton::bench::find_mirror_plugin();
  benchmark::AddCustomContext("built_with", ECITON_BUILT_WITH);
  std::vector<std::string> names;
  for (const Workload& workload : eciton::bench::all_workloads()) {
    names.push_back(workload.name);
    benchmark::RegisterBenchmark(workload.name.c_str(), run_workload, workload);
  }
  eciton::bench::KeepingReporter reporter(names);
  if (benchmark::RunSpecifiedBenchmarks(&reporter) == 0) return 2;  // the filter fits none: it has said so
  ok_or_throw(write_report_files(files, micro_result(reporter.kept(), ECITON_BUILT_WITH)));
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
