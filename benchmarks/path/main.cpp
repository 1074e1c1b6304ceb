// bench_path_main: `bench path` by itself, until the verb calls it.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "benchmarks/path/path.hpp"
#include "deploy/program.hpp"

namespace {

using namespace eciton;

int run(int argc, char** argv) {
  CLI::App app("From an IMU sample to a rotor command.");
  bench::PathOptions options;
  bench::ReportFiles files;
  app.add_option("--dds", options.vendors);
  app.add_option("--layout", options.layouts);
  app.add_option("--seconds", options.seconds);
  app.add_option("--rounds", options.rounds);
  app.add_option("--priority", options.realtime_priority);
  app.add_option("--seed", options.seed);
  app.add_option("--set", options.assignments)->allow_extra_args(false);
  app.add_flag("--whole", options.whole_module);
  app.add_option("--json", files.json);
  app.add_option("--csv", files.csv);
  app.add_option("--html", files.html);
  CLI11_PARSE(app, argc, argv);
  ok_or_throw(bench::check_report_files(files));
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  bench::ProgressLine line("bench path");
  const auto show = [&](std::size_t done, std::size_t all, double left_s, const std::string& doing) {
    line.show(done, all, left_s, doing);
  };
  const bench::Result result = bench::run_path(options, stop, show);
  std::printf("%s", bench::to_text(result).c_str());
  ok_or_throw(bench::write_report_files(files, result));
  return result.partial ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  return eciton::deploy::run_program("bench_path_main", [&] { return run(argc, argv); });
}
