// bench_formation_main: `bench formation` by itself, until the verb calls it.
#include "benchmarks/formation/formation.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "deploy/program.hpp"

namespace {

using namespace eciton;

int run(int argc, char** argv) {
  CLI::App app("Chain formation.");
  bench::FormationOptions options;
  bench::ReportFiles files;
  bool no_form = false, no_discovery = false, loopback = false;
  std::vector<std::string> pairs;
  app.add_option("--modules", options.modules);
  app.add_option("--loss", options.losses);
  app.add_option("--pair", pairs, "cyclonedds+fastdds");
  app.add_option("--pairs-at", options.pairs_at);
  app.add_option("--trials", options.trials);
  app.add_option("--sessions", options.sessions);
  app.add_option("--priority", options.realtime_priority);
  app.add_option("--discovery-modules", options.discovery_modules);
  app.add_option("--discovery-dds", options.discovery_vendors);
  app.add_option("--idle", options.idle_s);
  app.add_option("--joining", options.joining_s);
  app.add_option("--settle", options.settle_s);
  app.add_option("--seed", options.seed);
  app.add_option("--net", options.net);
  app.add_option("--set", options.assignments)->allow_extra_args(false);
  app.add_flag("--no-form", no_form);
  app.add_flag("--no-discovery", no_discovery);
  app.add_flag("--loopback", loopback);
  app.add_option("--json", files.json);
  app.add_option("--csv", files.csv);
  app.add_option("--html", files.html);
  CLI11_PARSE(app, argc, argv);
  options.form = !no_form;
  options.discover = !no_discovery;
  options.hosts = !loopback;
  if (!pairs.empty()) options.pairs.clear();
  for (const std::string& pair : pairs) {
    const std::size_t plus = std::min(pair.find('+'), pair.size());
    options.pairs.push_back({pair.substr(0, plus), pair.substr(std::min(plus + 1, pair.size()))});
  }
  ok_or_throw(bench::check_report_files(files));
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  bench::ProgressLine line("bench formation");
  const auto show = [&](std::size_t done, std::size_t all, double left_s, const std::string& doing) {
    line.show(done, all, left_s, doing);
  };
  const bench::Result result = bench::run_formation(options, stop, show);
  std::printf("%s", bench::to_text(result).c_str());
  ok_or_throw(bench::write_report_files(files, result));
  return result.partial ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  return eciton::deploy::run_program("bench_formation_main", [&] { return run(argc, argv); });
}
