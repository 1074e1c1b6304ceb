// The benches, as subcommands of one verb, and what they share.
#include "deploy/command/bench.hpp"

#include <cstdio>

namespace eciton::deploy {

void add_bench(CLI::App& app, Run& run) {
  CLI::App& verb = *app.add_subcommand("bench", "Measures latency and jitter beside what others offer");
  verb.require_subcommand(1);
  add_bench_latency(verb, run);
  add_bench_jitter(verb, run);
  add_bench_path(verb, run);
  add_bench_formation(verb, run);
}

void add_report_options(CLI::App& verb, bench::ReportFiles& files) {
  verb.add_option("--json", files.json, "file for the figures");
  verb.add_option("--csv", files.csv, "file for the raw samples");
  verb.add_option("--html", files.html, "file for the page with distributions");
}

int measure_and_tell(const std::string& command, const bench::ReportFiles& files,
                     const std::function<bench::Result(const runtime::StopFlag&, const bench::Progress&)>& measure) {
  ok_or_throw(bench::check_report_files(files));
  runtime::StopFlag stop;
  const runtime::StopOnSignals signals(stop);
  const bench::Result result = [&] {
    bench::ProgressLine line(command);
    return measure(stop, [&](std::size_t finished, std::size_t all, double left_s, const std::string& doing) {
      line.show(finished, all, left_s, doing);
    });
  }();
  std::fputs(bench::to_text(result).c_str(), stdout);
  ok_or_throw(bench::write_report_files(files, result));
  if (stop.requested()) return 130;
  return result.partial ? 1 : 0;
}

}  // namespace eciton::deploy
