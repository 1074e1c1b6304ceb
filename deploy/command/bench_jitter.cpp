// `eciton bench jitter`: its options.
#include <memory>

#include "benchmarks/jitter/jitter.hpp"
#include "deploy/command/bench.hpp"

namespace eciton::deploy {

void add_bench_jitter(CLI::App& bench, Run& run_chosen) {
  struct Options {
    bench::JitterOptions measure;
    bench::ReportFiles files;
  };
  auto options = std::make_shared<Options>();
  bench::JitterOptions& measure = options->measure;
  CLI::App& verb = *bench.add_subcommand("jitter", "Wake-ups of a 500 Hz service, beside cyclictest");
  verb.add_option("--conditions", measure.conditions, "idle, loaded, traffic")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"idle", "loaded", "traffic"}))
      ->capture_default_str();
  verb.add_option("--block", measure.block_s, "seconds after which the other takes its turn")
      ->check(CLI::Range(0.5, 600.0))
      ->capture_default_str();
  verb.add_option("--rounds", measure.rounds, "blocks of each of the two, per condition")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_option("--priority", measure.realtime_priority, "SCHED_FIFO of both, 0: none")
      ->check(CLI::Range(0, 98))
      ->capture_default_str();
  verb.add_option("--dds", measure.dds, "vendor of the traffic")->capture_default_str();
  verb.add_option("--seed", measure.seed, "of the confidence intervals")->capture_default_str();
  add_report_options(verb, options->files);
  on_chosen(verb, run_chosen, [options] {
    return measure_and_tell("bench jitter", options->files, [&](const auto& stop, const auto& progress) {
      return bench::run_jitter(options->measure, stop, progress);
    });
  });
}

}  // namespace eciton::deploy
