// Flights in turn, then their samples side by side.
#include "benchmarks/path/path.hpp"

#include <cstdio>
#include <cstdlib>

#include "benchmarks/path/module_flight.hpp"
#include "benchmarks/statistics/summary.hpp"
#include "deploy/supervisor/launch.hpp"

namespace eciton::bench {
namespace {

double us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

/// Everything measured of one variant, over all rounds.
struct VariantResult {
  FlightVariant variant;
  Samples total, to_estimation, to_control, to_rotors, age, inside;
  PathTrace counts;  // without samples
  std::vector<msg::Heartbeat> heartbeats;
};

Samples named(const FlightVariant& variant, const std::string& what) {
  Samples samples;
  samples.name = what + "." + variant.name();
  samples.unit = "us";
  samples.chart = variant.name();
  return samples;
}

VariantResult begin(const FlightVariant& variant) {
  return {.variant = variant,
          .total = named(variant, "imu_to_rotors"),
          .to_estimation = named(variant, "imu_to_estimation"),
          .to_control = named(variant, "estimation_to_control"),
          .to_rotors = named(variant, "control_to_rotors"),
          .age = named(variant, "age"),
          .inside = named(variant, "inside"),
          .counts = {},
          .heartbeats = {}};
}

void add(Samples& samples, double at_s, std::int64_t ns) {
  samples.at_s.push_back(at_s);
  samples.values.push_back(us(ns));
}

/// The k-th sample within the recorded time; those before are of the take-off.
void add_inside(VariantResult& result, const FlightRecord& record, std::int64_t begin_ns) {
  if (record.ticks.empty()) return;
  for (const InsideSample& s : record.inside) {
    if (s.in_ns < record.ticks.front().out_ns || s.in_ns > record.ticks.back().out_ns) continue;
    add(result.inside, us(s.in_ns - begin_ns) * 1e-6, s.out_ns - s.in_ns);
  }
}

void append(VariantResult& result, const FlightRecord& record, std::int64_t& begin_ns) {
  if (begin_ns == 0 && !record.ticks.empty()) begin_ns = record.ticks.front().out_ns;
  for (const PathSample& s : record.trace.samples) {
    const double at_s = us(s.out_ns - begin_ns) * 1e-6;
    add(result.total, at_s, s.rotors_ns);
    add(result.age, at_s, s.age_ns);
    if (!result.variant.staged()) continue;
    add(result.to_estimation, at_s, s.estimation_ns);
    add(result.to_control, at_s, s.control_ns - s.estimation_ns);
    add(result.to_rotors, at_s, s.rotors_ns - s.control_ns);
  }
  add_inside(result, record, begin_ns);
  result.total.sent += record.trace.ticks;
  result.total.lost += record.trace.ticks - record.trace.samples.size();
  result.total.partial = result.total.partial || !record.trouble.empty();
  result.counts.ticks += record.trace.ticks;
  result.counts.unanswered += record.trace.unanswered;
  result.counts.repeated += record.trace.repeated;
  result.counts.late += record.trace.late;
  result.counts.unseen += record.trace.unseen;
  result.heartbeats = record.heartbeats;
}

Table counts_table(const std::vector<VariantResult>& results) {
  Table table{
      .title = "What the rotors were told, tick by tick",
      .columns = {"", "ticks", "new command", "none new", "made of an older IMU sample", "not answered", "not seen"},
      .rows = {}};
  for (const VariantResult& r : results) {
    const PathTrace& c = r.counts;
    table.rows.push_back({r.variant.name(), std::to_string(c.ticks), std::to_string(r.total.values.size()),
                          std::to_string(c.repeated), std::to_string(c.late), std::to_string(c.unanswered),
                          std::to_string(c.unseen)});
  }
  return table;
}

/// As the services' own heartbeats say: of the flight's last second.
Table work_table(const std::vector<VariantResult>& results) {
  Table table{.title = "Time in a step, as the services' heartbeats say (µs, last second)",
              .columns = {"", "mean", "max", "period", "jitter p99", "overruns"},
              .rows = {}};
  for (const VariantResult& r : results) {
    for (const msg::Heartbeat& beat : r.heartbeats) {
      table.rows.push_back({r.variant.name() + ": " + beat.service.c_str(), number_text(beat.execution_s_mean * 1e6),
                            number_text(beat.execution_s_max * 1e6), number_text(beat.period_s * 1e6),
                            number_text(beat.jitter_s_p99 * 1e6), std::to_string(beat.overruns)});
    }
  }
  return table;
}

void add_metrics(Result& result, const Samples& samples) {
  if (samples.values.empty()) return;
  const Summary s = summarize(samples);
  result.metrics["p50_us." + samples.name] = s.p50;
  result.metrics["p99_us." + samples.name] = s.p99;
  result.metrics["max_us." + samples.name] = s.max;
}

void finish(Result& result, const std::vector<VariantResult>& results) {
  Bars bars{.title = "IMU sample to rotor command, p50", .unit = "us", .bars = {}, .limit = {}};
  for (const VariantResult& r : results) {
    std::vector<Samples> all{r.total, r.to_estimation, r.to_control, r.to_rotors, r.inside, r.age};
    std::erase_if(all, [](const Samples& s) { return s.values.empty(); });
    result.tables.push_back(summary_table(r.variant.name() + " (µs)", all));
    for (Samples& samples : all) {
      add_metrics(result, samples);
      result.samples.push_back(std::move(samples));
    }
    if (!r.total.values.empty()) {
      bars.bars.push_back({r.variant.vendor, r.variant.layout,
                           median_interval(cut(r.total.values, 20), result.seed.get<std::uint64_t>())});
    }
  }
  result.tables.push_back(counts_table(results));
  result.tables.push_back(work_table(results));
  result.bars.push_back(std::move(bars));
}

Json config_of(const PathOptions& o) {
  return {{"vendors", o.vendors},           {"layouts", o.layouts},
          {"seconds", o.seconds},           {"rounds", o.rounds},
          {"whole_module", o.whole_module}, {"realtime_priority", o.realtime_priority},
          {"module_id", o.module_id},       {"set", o.assignments}};
}

}  // namespace

Result run_path(const PathOptions& given, const runtime::StopFlag& stop, const Progress& progress) {
  const RunControl control{stop, progress};
  ::unsetenv("ECITON_DDS");  // the vendors asked for here count more
  PathOptions options = given;
  if (options.programs.empty()) options.programs = deploy::program_directory();
  std::vector<VariantResult> results;
  for (const std::string& vendor : options.vendors) {
    for (const std::string& layout : options.layouts) {
      check_variant(options, {vendor, layout});
      results.push_back(begin({vendor, layout}));
    }
  }
  Result result;
  result.title = "From an IMU sample to a rotor command";
  result.command = "bench path";
  result.clock = "wall";
  result.config = config_of(options);
  result.seed = options.seed;
  const auto order = abba_order(results.size(), options.rounds);
  constexpr double prelude_s = 8;  // start and take-off
  std::int64_t begin_ns = 0;
  for (std::size_t k = 0; k < order.size() && !control.stop.requested(); ++k) {
    VariantResult& r = results[order[k]];
    const double left_s = static_cast<double>(order.size() - k) * (options.seconds + prelude_s);
    try {
      const FlightRecord record = fly(options, r.variant, control, [&](const std::string& doing) {
        control.tell(k, order.size(), left_s, doing);
      });
      append(r, record, begin_ns);
      if (!record.trouble.empty()) result.notes.push_back(record.trouble);
    } catch (const BadInput& bad) {
      if (k == 0) throw;  // nothing was measured yet that would be lost
      result.notes.push_back(r.variant.name() + ": " + bad.error.message);
    }
  }
  result.partial = !result.notes.empty() || control.stop.requested();
  result.notes.push_back(
      "Times count from when the readings leave for the hardware host to when its commands are back, on the host's "
      "own clock; age counts from the IMU sample's own stamp.");
  finish(result, results);
  return result;
}

}  // namespace eciton::bench
