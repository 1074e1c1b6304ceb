// `eciton bench latency`: options to a plan, the measurement, and its result told.
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "benchmarks/latency/figures.hpp"
#include "benchmarks/latency/measure.hpp"
#include "benchmarks/latency/overhead.hpp"
#include "deploy/command/bench.hpp"

namespace eciton::deploy {
namespace {

struct Options {
  bench::LatencyOptions measure;
  bench::ReportFiles files;
  bool anywhere = false;
};

/// What --quick stands for, where nothing else was said.
void hasten(bench::LatencyOptions& options, const CLI::App& verb) {
  if (!options.quick) return;
  if (verb.count("--rates") == 0) options.rates_Hz = {1500};
  if (verb.count("--duration") == 0) options.duration_s = 20;  // ends by time
  // Many short blocks: neighbours share their weather, and confidence grows with their number.
  if (verb.count("--block") == 0) options.block_s = 0.05;
}

int run(Options options, const CLI::App& verb) {
  bench::LatencyOptions& measure = options.measure;
  hasten(measure, verb);
  if (!measure.hosts.empty()) {
    if (measure.hosts.size() != 2) throw BadInput{{"--hosts: give two, as in --hosts m1,m2: one pings, one echoes"}};
    if (verb.count("--over") == 0) measure.over = {"hosts"};
  }
  measure.pin = !options.anywhere;
  ok_or_throw(bench::check_report_files(options.files));
  const bench::Plan plan = value_or_throw(bench::make_plan(measure));
  runtime::StopFlag stop;
  const runtime::StopOnSignals signals(stop);
  bench::Measured measured;
  bench::Overhead overhead;
  {
    bench::ProgressLine progress("bench latency");
    overhead = bench::measure_overhead(measure, stop);
    measured = bench::measure_latency(
        measure, plan, stop, [&](std::size_t finished, std::size_t all, double left_s, const std::string& doing) {
          progress.show(finished, all, left_s, doing);
        });
  }
  const bench::Result result = bench::latency_result(measure, plan, measured, overhead);
  std::fputs(bench::to_text(result).c_str(), stdout);
  ok_or_throw(bench::write_report_files(options.files, result));
  if (measured.interrupted) return 130;
  return measured.partial ? 1 : 0;
}

}  // namespace

void add_bench_latency(CLI::App& bench, Run& run_chosen) {
  auto options = std::make_shared<Options>();
  bench::LatencyOptions& measure = options->measure;
  CLI::App& verb =
      *bench.add_subcommand("latency", "Round trip and one way, ours beside native DDS, UDP, ZeroMQ, LCM");
  const auto list = [&](const char* name, auto& value, const char* help) {
    verb.add_option(name, value, help)->delimiter(',')->allow_extra_args(false)->capture_default_str();
  };
  verb.add_flag("--quick", measure.quick, "at most 60 s; for medians, not for tails");
  list("--vendors", measure.vendors, "every ordered pair of them");
  list("--sizes", measure.bytes, "bytes of payload: 64, 256, 1024, 4096");
  list("--rates", measure.rates_Hz, "samples a second, sent at planned instants");
  list("--qos", measure.qos, "classes: sensor (best effort), command (reliable)");
  list("--modes", measure.deliveries, "wake: the waiting thread takes; inline: the transport's thread delivers");
  list("--baselines", measure.baselines, "native, udp, ddsperf, zeromq, lcm, none");
  verb.add_option("--duration", measure.duration_s, "seconds for each lane with each size, rate and class")
      ->check(CLI::Range(0.1, 36000.0))
      ->capture_default_str();
  verb.add_option("--block", measure.block_s, "seconds after which the next lane takes its turn")
      ->check(CLI::Range(0.01, 60.0))
      ->capture_default_str();
  list("--over", measure.over, "loopback; hosts: two of a net of its own; impaired: the same, disturbed");
  list("--impairment", measure.impairment, "of that, as 'eciton net set' takes it");
  list("--hosts", measure.hosts, "two network namespaces to use instead, as eciton-m1,eciton-m2");
  verb.add_option("--interface", measure.network_interface, "of both ends (default: lo, eth0 in hosts)");
  list("--peers", measure.peers, "addresses for discovery instead of multicast");
  verb.add_option("--domain", measure.domain, "first DDS domain; each lane takes one")->capture_default_str();
  verb.add_option("--priority", measure.priority, "SCHED_FIFO for all peers, 0: none (default: 20 where it may be)")
      ->check(CLI::Range(0, 99));
  verb.add_flag("--anywhere", options->anywhere, "do not pin the two ends to two processors");
  verb.add_option("--patience", measure.patience_s, "seconds for the peers to appear")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  verb.add_option("--programs", measure.programs,
                  "directory of the eciton-bench-peer-* programs (default: beside this one)");
  verb.add_option("--seed", measure.seed, "of the confidence intervals")->capture_default_str();
  add_report_options(verb, options->files);
  on_chosen(verb, run_chosen, [options, &verb] { return run(*options, verb); });
}

}  // namespace eciton::deploy
