// `eciton bench formation`: its options.
#include <memory>

#include "benchmarks/formation/formation.hpp"
#include "deploy/command/bench.hpp"

namespace eciton::deploy {
namespace {

/// "cyclonedds+fastdds"
bench::VendorPair read_pair(const std::string& text) {
  const std::size_t plus = text.find('+');
  if (plus == std::string::npos) {
    throw BadInput{{"--pairs " + text + ": expected two vendors, as in cyclonedds+fastdds"}};
  }
  return {text.substr(0, plus), text.substr(plus + 1)};
}

}  // namespace

void add_bench_formation(CLI::App& bench, Run& run_chosen) {
  struct Options {
    bench::FormationOptions measure;
    bench::ReportFiles files;
    std::vector<std::string> pairs;
    bool loopback = false;
  };
  auto options = std::make_shared<Options>();
  bench::FormationOptions& measure = options->measure;
  CLI::App& verb = *bench.add_subcommand("formation", "From a latch to a chain, and what discovery costs on the air");
  const auto list = [&](const char* name, auto& value, const char* help) {
    verb.add_option(name, value, help)->delimiter(',')->allow_extra_args(false)->capture_default_str();
  };
  list("--modules", measure.modules, "how many, 2 to 8");
  list("--losses", measure.losses, "of every directed link, 0 to 1");
  list("--pairs", options->pairs, "vendors that members alternate between (default: all four)");
  verb.add_option("--pairs-at", measure.pairs_at, "modules with which every pair is tried")->capture_default_str();
  verb.add_option("--trials", measure.trials, "latches, per case")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  verb.add_option("--priority", measure.realtime_priority, "SCHED_FIFO of the members' services, 0: none")
      ->check(CLI::Range(0, 90))
      ->capture_default_str();
  list("--discovery-modules", measure.discovery_modules, "how many modules find each other");
  list("--discovery-dds", measure.discovery_vendors, "vendors");
  verb.add_option("--idle", measure.idle_s, "seconds listened to when all have met")->capture_default_str();
  verb.add_flag("!--no-form", measure.form, "discovery alone");
  verb.add_flag("!--no-discovery", measure.discover, "formation alone");
  verb.add_flag("--loopback", options->loopback, "without hosts; nothing is lost there");
  verb.add_option("--net", measure.net, "name of its net")->capture_default_str();
  verb.add_option("--set", measure.assignments, "key=value, of the modules")->allow_extra_args(false);
  verb.add_option("--seed", measure.seed, "of the radio and of when a latch catches")->capture_default_str();
  add_report_options(verb, options->files);
  on_chosen(verb, run_chosen, [options] {
    options->measure.hosts = !options->loopback;
    if (!options->pairs.empty()) options->measure.pairs.clear();
    for (const std::string& pair : options->pairs) options->measure.pairs.push_back(read_pair(pair));
    return measure_and_tell("bench formation", options->files, [&](const auto& stop, const auto& progress) {
      return bench::run_formation(options->measure, stop, progress);
    });
  });
}

}  // namespace eciton::deploy
