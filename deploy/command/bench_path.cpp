// `eciton bench path`: its options.
#include <memory>

#include "benchmarks/path/path.hpp"
#include "deploy/command/bench.hpp"

namespace eciton::deploy {

void add_bench_path(CLI::App& bench, Run& run_chosen) {
  struct Options {
    bench::PathOptions measure;
    bench::ReportFiles files;
  };
  auto options = std::make_shared<Options>();
  bench::PathOptions& measure = options->measure;
  CLI::App& verb = *bench.add_subcommand("path", "From an IMU sample to a rotor command, stage by stage");
  verb.add_option("--dds", measure.vendors, "vendors")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  verb.add_option("--layouts", measure.layouts, "services: a process each; composed; one-process")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"services", "composed", "one-process"}))
      ->capture_default_str();
  verb.add_option("--duration", measure.seconds, "seconds of hovering flight, per round")
      ->check(CLI::Range(0.5, 3600.0))
      ->capture_default_str();
  verb.add_option("--rounds", measure.rounds, "of all of them, forward and backward in turn")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_flag("--whole", measure.whole_module, "with docking, joints and radio");
  verb.add_option("--priority", measure.realtime_priority, "SCHED_FIFO of the services, 0: none")
      ->check(CLI::Range(0, 90))
      ->capture_default_str();
  verb.add_option("--seed", measure.seed, "of the world")->capture_default_str();
  verb.add_option("--set", measure.assignments, "key=value, of the module")->allow_extra_args(false);
  add_report_options(verb, options->files);
  on_chosen(verb, run_chosen, [options] {
    return measure_and_tell("bench path", options->files, [&](const auto& stop, const auto& progress) {
      return bench::run_path(options->measure, stop, progress);
    });
  });
}

}  // namespace eciton::deploy
