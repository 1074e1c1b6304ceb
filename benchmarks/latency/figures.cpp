// Ratios, tables and metrics from the streams of a run.
#include "benchmarks/latency/figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "benchmarks/statistics/summary.hpp"

namespace eciton::bench {
namespace {

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return std::isnan(value) ? "–" : buffer;
}

std::string cell_title(const Cell& cell) {
  return std::to_string(cell.bytes) + " B, " + text("%.0f", cell.rate_Hz) + " Hz, " + cell.qos + ", " + cell.over;
}

double per(double sum, std::uint64_t count) { return count == 0 ? 0 : sum / static_cast<double>(count); }

class Figures {
 public:
  Figures(const LatencyOptions& options, const Plan& plan, const Measured& measured, const Overhead& overhead)
      : options_(options), plan_(plan), measured_(measured), overhead_(overhead) {}

  Result make() {
    result_.title = "Latency";
    result_.command = "bench latency";
    result_.clock = "monotonic";
    result_.seed = options_.seed;
    result_.partial = measured_.partial || plan_.missing || measured_.missing;
    configure();
    tell_ratios();
    tell_distributions();
    tell_costs();
    tell_ddsperf();
    tell_overhead();
    tell_notes();
    return std::move(result_);
  }

 private:
  void configure() {
    result_.config = {{"vendors", options_.vendors},
                      {"sizes_B", options_.bytes},
                      {"rates_Hz", options_.rates_Hz},
                      {"qos", options_.qos},
                      {"modes", options_.deliveries},
                      {"baselines", options_.baselines},
                      {"duration_s", options_.duration_s},
                      {"block_s", options_.block_s},
                      {"quick", options_.quick},
                      {"interface", options_.network_interface},
                      {"over", options_.over},
                      {"hosts", options_.hosts},
                      {"impairment", options_.impairment},
                      {"priority", options_.priority},
                      {"pinned", options_.pin}};
  }

  const Stream* find(const std::string& lane, const Cell& cell) const {
    for (const Stream& each : measured_.streams) {
      if (each.lane == lane && each.cell.suffix() == cell.suffix()) return &each;
    }
    return nullptr;
  }

  void metric(const std::string& name, double value) {
    if (std::isfinite(value)) result_.metrics[name] = value;
  }
  void metric(const std::string& name, const std::string& suffix, const Interval& interval) {
    metric(name + "." + suffix, interval.value);
    metric(name + "_low." + suffix, interval.low);
    metric(name + "_high." + suffix, interval.high);
  }

  /// One row: `name` metric, both quantiles, their ratio, what it may be.
  void add_ratio(Table& table, const Stream& above, const Stream& below, const std::string& name, double fraction,
                 double bar) {
    const std::string suffix = above.vendor + "." + above.delivery + "." + above.cell.suffix();
    const Interval ratio = ratio_interval(above.round_trip_us, below.round_trip_us, fraction, options_.seed);
    if (std::isnan(ratio.value)) return;
    metric(name, suffix, ratio);
    // A median is judged by its upper bound, a tail by itself.
    const double judged = fraction == 0.5 ? ratio.high : ratio.value;
    const auto of = [&](const Stream& stream) {
      std::vector<double> all;
      for (const auto& block : stream.round_trip_us) all.insert(all.end(), block.begin(), block.end());
      return resolves(all.size(), fraction) ? number_text(quantile(all, fraction)) : std::string("–");
    };
    table.rows.push_back(
        {above.label + " / " + below.label + ", " + std::to_string(above.cell.bytes) + " B" +
             (above.cell.plain ? ""
                               : text(", %.0f Hz, ", above.cell.rate_Hz) + above.cell.qos + ", " + above.cell.over),
         fraction == 0.5 ? "p50" : "p99", of(above), of(below), interval_text(ratio),
         std::isnan(bar) ? "" : "≤ " + number_text(bar),
         std::isnan(bar) ? ""
         : judged <= bar ? "held"
                         : "missed"});
  }

  void tell_ratios() {
    Table table{
        "Ratios of round trips, with 95 % confidence (µs)", {"", "", "ours", "baseline", "ratio", "bar", ""}, {}};
    Bars bars{"Round trip of ours over that of the vendor's own API, p50", "", {}, LatencyBars::tax_p50};
    for (const Stream& ours : measured_.streams) {
      if (ours.kind != Kind::ours || ours.vendor.empty()) continue;
      if (const Stream* native = find("native." + ours.vendor + "." + ours.delivery, ours.cell)) {
        const bool judged = ours.cell.over == "loopback";  // elsewhere the radio emulator is most of it
        add_ratio(table, ours, *native, "tax_p50", 0.5, judged ? LatencyBars::tax_p50 : std::nan(""));
        if (!options_.quick)
          add_ratio(table, ours, *native, "tax_p99", 0.99, judged ? LatencyBars::tax_p99 : std::nan(""));
        bars.bars.push_back({std::to_string(ours.cell.bytes) + " B" +
                                 (ours.cell.plain ? "" : " " + ours.cell.qos + ", " + ours.cell.over),
                             ours.label,
                             ratio_interval(ours.round_trip_us, native->round_trip_us, 0.5, options_.seed)});
      }
    }
    for (const Stream& ours : measured_.streams) {
      if (ours.kind != Kind::ours || ours.vendor.empty()) continue;
      if (const Stream* udp = find("udp", ours.cell))
        add_ratio(table, ours, *udp, "over_udp_p50", 0.5, udp_bar(ours));
    }
    if (!table.rows.empty()) result_.tables.push_back(std::move(table));
    if (!bars.bars.empty()) result_.bars.push_back(std::move(bars));
  }

  static double udp_bar(const Stream& ours) {
    if (ours.vendor != "cyclonedds" || ours.cell.bytes != 256 || ours.cell.qos != "sensor" ||
        ours.cell.over != "loopback") {
      return std::nan("");
    }
    return ours.delivery == "wake" ? LatencyBars::over_udp_wake : LatencyBars::over_udp_inline;
  }

  Samples samples(const char* what, const Stream& stream, const std::vector<double>& values,
                  const char* chart) const {
    Samples made;
    made.name = std::string(what) + "." + stream.name();
    made.unit = "µs";
    made.values = values;
    if (values.size() == stream.at_s.size()) made.at_s = stream.at_s;
    made.sent = stream.sent;
    made.lost = stream.lost;
    made.duplicates = stream.duplicates;
    made.partial = stream.partial();
    made.chart = std::string(chart) + ", " + cell_title(stream.cell);
    return made;
  }

  void add_summary(const char* name, const Stream& stream, const std::vector<double>& values) {
    Samples named;
    named.values = values;
    const Summary s = summarize(named);
    const auto add = [&](const char* which, double value) {
      metric(std::string(name) + "_us_" + which + "." + stream.name(), value);
    };
    add("p50", s.p50);
    add("p90", s.p90);
    add("p99", s.p99);
    if (resolves(s.count, 0.999)) add("p999", s.p999);
    if (resolves(s.count, 0.9999)) add("p9999", s.p9999);
    add("max", s.max);
    add("jitter_mean", s.jitter_mean);
    add("jitter_p99", s.jitter_p99);
  }

  void tell_distributions() {
    for (const Cell& cell : plan_.cells) {
      std::vector<Samples> round_trips, one_ways;
      for (const Stream& stream : measured_.streams) {
        if (stream.cell.suffix() != cell.suffix() || stream.sent == 0) continue;
        round_trips.push_back(samples("round_trip", stream, stream.from_plan_us, "Round trip"));
        one_ways.push_back(samples("one_way", stream, stream.there_us, "One way"));
        add_summary("round_trip", stream, stream.from_plan_us);
        add_summary("one_way", stream, stream.there_us);
        metric("loss." + stream.name(), per(static_cast<double>(stream.lost), stream.sent));
        metric("duplicates." + stream.name(), static_cast<double>(stream.duplicates));
      }
      if (round_trips.empty()) continue;
      result_.tables.push_back(
          summary_table("Round trip from the planned instant, " + cell_title(cell), round_trips));
      result_.tables.push_back(summary_table("One way from sending to receipt, " + cell_title(cell), one_ways));
      for (auto* group : {&round_trips, &one_ways}) {
        for (Samples& each : *group) result_.samples.push_back(std::move(each));
      }
    }
  }

  void tell_costs() {
    Table table{
        "Cost of a round trip at the ping and the echo, and how late the sender was",
        {"", "CPU µs", "", "switches", "", "allocations", "", "RSS MB", "", "late p50 µs", "late p99 µs", "held up"},
        {}};
    for (const Stream& stream : measured_.streams) {
      if (stream.sent == 0) continue;
      std::vector<std::string> row{stream.name()};
      const auto both = [&](const char* name, double ping, double echo, const char* format) {
        metric(std::string(name) + "." + stream.name(), ping + echo);
        row.push_back(text(format, ping));
        row.push_back(text(format, echo));
      };
      both("cpu_us", per(stream.ping.cpu_us, stream.sent), per(stream.echo.cpu_us, stream.sent), "%.1f");
      both("switches", per(stream.ping.switches, stream.sent), per(stream.echo.switches, stream.sent), "%.2f");
      if (stream.ping.allocations_counted && stream.echo.allocations_counted) {
        both("allocations", per(stream.ping.allocations, stream.sent), per(stream.echo.allocations, stream.sent),
             "%.2f");
      } else {
        row.insert(row.end(), 2, "–");
      }
      both("rss_MB", stream.ping.rss_MB_max, stream.echo.rss_MB_max, "%.1f");
      row.push_back(number_text(quantile(stream.late_us, 0.5)));
      row.push_back(number_text(quantile(stream.late_us, 0.99)));
      row.push_back(std::to_string(stream.held_up));
      metric("sender_late_us_p99." + stream.name(), quantile(stream.late_us, 0.99));
      table.rows.push_back(std::move(row));
      tell_damage(stream);
    }
    if (!table.rows.empty()) result_.tables.push_back(std::move(table));
  }

  void tell_damage(const Stream& stream) {
    if (stream.corrupt > 0)
      result_.notes.push_back(stream.name() + ": " + std::to_string(stream.corrupt) + " samples arrived damaged");
    if (stream.refused > 0)
      result_.notes.push_back(stream.name() + ": " + std::to_string(stream.refused) +
                              " samples were refused by the transport when sent");
  }

  void tell_ddsperf() {
    Table table{"ddsperf, medians over its windows of one second: whole round trips, twice what it reports (µs)",
                {"", "windows", "mean", "p50", "p90", "p99", "max"},
                {}};
    for (const DdsperfRun& run : measured_.ddsperf) {
      if (run.windows.empty()) continue;
      const auto median = [&](double DdsperfWindow::*which) {
        std::vector<double> values;
        for (const DdsperfWindow& window : run.windows) values.push_back(window.*which);
        return quantile(values, 0.5);
      };
      const std::string name = run.delivery + "." + run.cell.suffix();
      metric("ddsperf_us_p50." + name, median(&DdsperfWindow::p50_us));
      metric("ddsperf_us_p99." + name, median(&DdsperfWindow::p99_us));
      table.rows.push_back({"ddsperf." + name, std::to_string(run.windows.size()),
                            number_text(median(&DdsperfWindow::mean_us)), number_text(median(&DdsperfWindow::p50_us)),
                            number_text(median(&DdsperfWindow::p90_us)), number_text(median(&DdsperfWindow::p99_us)),
                            number_text(median(&DdsperfWindow::max_us))});
    }
    if (!table.rows.empty()) result_.tables.push_back(std::move(table));
  }

  void tell_overhead() {
    if (!overhead_.trouble.empty()) {
      result_.notes.push_back("the framework's own code was not measured: " + overhead_.trouble);
      return;
    }
    metric("framework_write_ns.256", overhead_.write_ns);
    metric("framework_take_ns.256", overhead_.take_ns);
    metric("framework_allocations.256", overhead_.allocations);
    metric("sim_network_us_p50.256", overhead_.sim_network_us);
    Table table{"The framework's own code, one process, 256 B", {"", "", "bar", ""}, {}};
    const auto row = [&](const char* name, double value, double bar, const std::string& shown) {
      table.rows.push_back({name, shown, "≤ " + number_text(bar), value <= bar ? "held" : "missed"});
    };
    row("serialize and hand over", overhead_.write_ns, LatencyBars::framework_ns,
        text("%.0f ns", overhead_.write_ns));
    row("take and deserialize", overhead_.take_ns, LatencyBars::framework_ns, text("%.0f ns", overhead_.take_ns));
    row("allocations per sample", overhead_.allocations, 0, text("%.3g", overhead_.allocations));
    row("write to take over sim_network", overhead_.sim_network_us, LatencyBars::sim_network_us,
        text("%.3f µs", overhead_.sim_network_us));
    result_.tables.push_back(std::move(table));
  }

  void tell_notes() {
    auto& notes = result_.notes;
    for (const auto* from : {&plan_.notes, &measured_.notes}) {
      for (const std::string& note : *from) {
        if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
      }
    }
    notes.emplace_back(
        "One way: both ends read CLOCK_MONOTONIC of one kernel, in whatever network namespace: the clock's error is "
        "0.");
    if (std::find(options_.over.begin(), options_.over.end(), "impaired") != options_.over.end()) {
      notes.emplace_back(
          "Over the impaired link, best-effort DDS drops what arrives after a newer sample: it is lost.");
    }
    notes.push_back("All threads of all peers: " +
                    (options_.priority > 0 ? "SCHED_FIFO " + std::to_string(options_.priority) : "SCHED_OTHER") +
                    (options_.pin ? ", pings on processor 0, echoes on 1" : ", on any processor") +
                    "; timer slack 1 ns; nothing spins.");
    if (measured_.interrupted) notes.emplace_back("Interrupted: these are the figures up to then.");
  }

  const LatencyOptions& options_;
  const Plan& plan_;
  const Measured& measured_;
  const Overhead& overhead_;
  Result result_;
};

}  // namespace

Result latency_result(const LatencyOptions& options, const Plan& plan, const Measured& measured,
                      const Overhead& overhead) {
  return Figures(options, plan, measured, overhead).make();
}

}  // namespace eciton::bench
