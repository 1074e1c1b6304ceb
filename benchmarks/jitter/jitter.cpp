// Blocks of ours and of cyclictest in ABBA order under one background, then their quantiles and the ratio of them.
#include "benchmarks/jitter/jitter.hpp"

#include <pthread.h>
#include <sched.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "benchmarks/jitter/background.hpp"
#include "benchmarks/jitter/control_work.hpp"
#include "benchmarks/jitter/cyclictest.hpp"
#include "benchmarks/statistics/summary.hpp"
#include "core/base/wall_clock.hpp"
#include "core/bus/plugin_loader.hpp"
#include "core/runtime/realtime_executor.hpp"
#include "deploy/supervisor/launch.hpp"
#include "deploy/supervisor/supervisor.hpp"

namespace eciton::bench {
namespace {

constexpr Duration period = std::chrono::milliseconds(2);
constexpr std::uint32_t module_id = 80;
constexpr Duration settle = std::chrono::milliseconds(1500);  // of a background

struct Block {
  std::vector<double> late_us;
  std::uint64_t overruns = 0;
  double step_us_mean = 0, step_us_p99 = 0;
  Duration stolen{};
  std::string trouble;
};

/// All blocks of one of the two under one condition.
struct Side {
  Samples samples;
  Blocks blocks;
  std::uint64_t overruns = 0;
  Duration stolen{};
  double step_us_mean = 0, step_us_p99 = 0;
};

struct Condition {
  std::string name;
  Side ours, baseline;
};

/// Whether this process may have what it will ask for: asked on a thread that ends.
Status check_priority(int priority) {
  if (priority == 0) return ok();
  int error = 0;
  std::thread([&] {
    const sched_param parameters{.sched_priority = priority};
    error = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
  }).join();
  if (error == 0) return ok();
  return Error{"no right to SCHED_FIFO at priority " + std::to_string(priority) +
               ": run as root or with CAP_SYS_NICE, or give priority 0 to measure without"};
}

/// Until the end of the block, or a stop.
void wait_for_end(double seconds, const runtime::StopFlag& stop) {
  std::vector<pollfd> wait{{stop.file_descriptor(), POLLIN, 0}};
  deploy::wait_for(wait, from_s(seconds));
}

/// A block that could not be measured says why; those before it are not lost.
Block run_ours(const JitterOptions& options, const runtime::StopFlag& stop) try {
  Block block;
  const auto at_most = static_cast<std::size_t>(2 * options.block_s / to_s(period)) + 10;
  bus::Participant ring({.vendor = options.dds, .domain = options.domain, .name = "control"});
  ControlWork work(ring, module_id, period, at_most);
  runtime::RealtimeExecutor executor(
      {.module_id = module_id, .process = "control", .realtime_priority = options.realtime_priority}, {&ring});
  executor.add(work);
  const runtime::ServiceGroup::Entry& entry = *executor.group().entries().front();
  work.watch(entry);
  runtime::StopFlag block_ends;
  std::thread thread([&] { executor.run(block_ends); });
  wait_for_end(options.block_s, stop);
  block_ends.request();
  thread.join();
  block.late_us = work.late_us();
  block.overruns = entry.statistics.overruns();
  block.step_us_mean = to_s(entry.statistics.execution_mean()) * 1e6;
  block.step_us_p99 = to_s(entry.statistics.execution().p99) * 1e6;
  if (!work.flies()) block.trouble = "control did not take off, so it did less than its work";
  return block;
} catch (const BadInput& bad) {
  Block block;
  block.trouble = bad.error.message;
  return block;
}

Block run_baseline(const JitterOptions& options, const std::string& program, const runtime::StopFlag& stop) {
  Block block;
  const auto late_us = run_cyclictest(
      program, {.period = period, .realtime_priority = options.realtime_priority, .seconds = options.block_s}, stop);
  if (!late_us) {
    block.trouble = late_us.error().message;
    return block;
  }
  block.late_us = *late_us;
  for (const double late : block.late_us) {
    block.overruns += static_cast<std::uint64_t>(late * 1e-6 / to_s(period));
  }
  return block;
}

void append(Side& all, const Block& block, double at_s) {
  for (std::size_t k = 0; k < block.late_us.size(); ++k) {
    all.samples.at_s.push_back(at_s + static_cast<double>(k) * to_s(period));
    all.samples.values.push_back(block.late_us[k]);
  }
  all.blocks.push_back(block.late_us);
  all.overruns += block.overruns;
  all.stolen += block.stolen;
  all.step_us_mean = block.step_us_mean;
  all.step_us_p99 = std::max(all.step_us_p99, block.step_us_p99);
}

Condition make_condition(const std::string& name) {
  Condition condition{.name = name, .ours = {}, .baseline = {}};
  for (Samples* samples : {&condition.ours.samples, &condition.baseline.samples}) {
    samples->name = (samples == &condition.ours.samples ? "ours." : "cyclictest.") + name;
    samples->unit = "us";
    samples->chart = name;
  }
  return condition;
}

std::string load_average() {
  std::ifstream file("/proc/loadavg");
  std::string value;
  file >> value;
  return value;
}

/// The blocks of one condition. What goes wrong is noted, and ends the condition.
class ConditionRun {
 public:
  ConditionRun(const JitterOptions& options, const std::string& cyclictest, const RunControl& control, Result& result)
      : options_(options), cyclictest_(cyclictest), control_(control), result_(result), begin_(monotonic_now()) {}

  Condition run(const std::string& name, std::size_t finished, std::size_t all) {
    Condition condition = make_condition(name);
    const std::string before = load_average();
    const auto background = Background::start(name, options_);
    if (!background) return stop_at(condition, background.error().message);
    if (name != "idle") wait_for_end(to_s(settle), control_.stop);
    result_.notes.push_back(name + ": load average before it began " + before);
    const auto order = abba_order(cyclictest_.empty() ? 1 : 2, options_.rounds);
    for (std::size_t k = 0; k < order.size() && !control_.stop.requested(); ++k) {
      const bool ours = order[k] == 0;
      control_.tell(finished + k, all, static_cast<double>(all - finished - k) * options_.block_s,
                    (ours ? "ours, " : "cyclictest, ") + name);
      const double at_s = to_s(monotonic_now() - begin_);
      const auto stolen_before = stolen();
      Block block = ours ? run_ours(options_, control_.stop) : run_baseline(options_, cyclictest_, control_.stop);
      if (const auto stolen_after = stolen(); stolen_before && stolen_after)
        block.stolen = *stolen_after - *stolen_before;
      append(ours ? condition.ours : condition.baseline, block, at_s);
      if (!block.trouble.empty()) return stop_at(condition, block.trouble);
      if (const std::string trouble = (*background)->trouble(); !trouble.empty()) return stop_at(condition, trouble);
    }
    return condition;
  }

 private:
  Condition stop_at(Condition& condition, const std::string& why) {
    result_.notes.push_back(condition.name + ": " + why);
    result_.partial = true;
    condition.ours.samples.partial = condition.baseline.samples.partial = true;
    return condition;
  }

  const JitterOptions& options_;
  const std::string& cyclictest_;
  const RunControl& control_;
  Result& result_;
  Duration begin_;
};

std::string milliseconds_text(Duration d) { return number_text(to_s(d) * 1e3); }

void add_figures(Result& result, const std::string& name, const Side& of) {
  if (of.samples.values.empty()) return;
  const Summary s = summarize(of.samples);
  const std::string suffix = "." + name;
  result.metrics["late_us_p50" + suffix] = s.p50;
  result.metrics["late_us_p99" + suffix] = s.p99;
  result.metrics["late_us_p999" + suffix] = s.p999;
  result.metrics["late_us_max" + suffix] = s.max;
  result.metrics["overruns" + suffix] = of.overruns;
  result.metrics["stolen_ms" + suffix] = to_s(of.stolen) * 1e3;
}

void add_ratio(Result& result, const Condition& c, std::uint64_t seed, Table& table, Bars& bars) {
  const std::size_t pairs = std::min(c.ours.blocks.size(), c.baseline.blocks.size());
  if (pairs == 0) return;
  const Blocks ours(c.ours.blocks.begin(), c.ours.blocks.begin() + static_cast<std::ptrdiff_t>(pairs));
  const Blocks base(c.baseline.blocks.begin(), c.baseline.blocks.begin() + static_cast<std::ptrdiff_t>(pairs));
  const Interval p50 = ratio_interval(ours, base, 0.5, seed), p99 = ratio_interval(ours, base, 0.99, seed);
  table.rows.push_back({c.name, interval_text(p50), interval_text(p99)});
  bars.bars.push_back({c.name, "p50", p50});
  bars.bars.push_back({c.name, "p99", p99});
  result.metrics["jitter_ratio_p50." + c.name] = p50.value;
  result.metrics["jitter_ratio_p99." + c.name] = p99.value;
}

void finish(Result& result, std::vector<Condition>& conditions, const JitterOptions& options) {
  Table ratios{.title = "Lateness of a wake-up, ours / cyclictest", .columns = {"", "p50", "p99"}, .rows = {}};
  Table work{.title = "Overruns, stolen time, work in a step",
             .columns = {"", "overruns", "stolen (ms)", "step mean (µs)", "step p99 (µs)"},
             .rows = {}};
  Bars bars{.title = "Lateness of a wake-up, ours / cyclictest", .unit = "ratio", .bars = {}, .limit = 1.15};
  std::vector<Samples> all;
  for (Condition& c : conditions) {
    for (Side* of : {&c.ours, &c.baseline}) {
      add_figures(result, of->samples.name, *of);
      const bool ours = of == &c.ours;
      if (of->samples.values.empty()) continue;
      work.rows.push_back({of->samples.name, std::to_string(of->overruns), milliseconds_text(of->stolen),
                           ours ? number_text(of->step_us_mean) : "–", ours ? number_text(of->step_us_p99) : "–"});
      all.push_back(of->samples);
    }
    add_ratio(result, c, options.seed, ratios, bars);
  }
  result.tables = {summary_table("Lateness of a 500 Hz wake-up", all), ratios, work};
  result.bars.push_back(std::move(bars));
  result.samples = std::move(all);
}

}  // namespace

Result run_jitter(const JitterOptions& given, const runtime::StopFlag& stop, const Progress& progress) {
  const RunControl control{stop, progress};
  ::unsetenv("ECITON_DDS");  // the vendor asked for here counts more
  JitterOptions options = given;
  if (options.programs.empty()) options.programs = deploy::program_directory();
  for (const std::string& condition : options.conditions) ok_or_throw(Background::check(condition, options));
  ok_or_throw(check_priority(options.realtime_priority));
  if (const auto plugin = bus::load_plugin(options.dds); !plugin) throw BadInput{plugin.error()};
  const std::string cyclictest = options.cyclictest ? value_or_throw(find_tool("cyclictest", "rt-tests")) : "";

  Result result;
  result.title = "Wake-up jitter";
  result.command = "bench jitter";
  result.clock = "monotonic";
  result.config = {{"conditions", options.conditions}, {"block_s", options.block_s},
                   {"rounds", options.rounds},         {"realtime_priority", options.realtime_priority},
                   {"cyclictest", options.cyclictest}, {"dds", options.dds},
                   {"domain", options.domain},         {"period_s", to_s(period)}};
  result.seed = options.seed;
  std::vector<Condition> conditions;
  const std::size_t blocks = options.rounds * (options.cyclictest ? 2 : 1);
  ConditionRun run(options, cyclictest, control, result);
  for (const std::string& name : options.conditions) {
    if (control.stop.requested()) break;
    conditions.push_back(run.run(name, conditions.size() * blocks, options.conditions.size() * blocks));
  }
  result.partial = result.partial || control.stop.requested();
  finish(result, conditions, options);
  return result;
}

}  // namespace eciton::bench
