// `eciton topic hz | delay | bw`: one figure of each sample, summed up key by key, window by window.
#include <cstdio>
#include <map>

#include "deploy/command/listener.hpp"
#include "deploy/command/measured_series.hpp"
#include "deploy/command/measurement.hpp"
#include "deploy/command/topic.hpp"

namespace eciton::deploy {
namespace {

/// What one key's samples showed.
struct Row {
  MeasuredSeries window;
  MeasuredSeries all;
  std::uint64_t samples = 0;
  std::uint64_t samples_in_window = 0;
  Duration first{};
  Duration last{};
  std::int64_t first_stamp_ns = 0;
  std::int64_t last_stamp_ns = 0;

  double rate_Hz() const { return samples > 1 ? static_cast<double>(samples - 1) / to_s(last - first) : 0; }
  double rate_by_stamps_Hz() const {
    const double span_s = to_s(Duration{last_stamp_ns - first_stamp_ns});
    return samples > 1 && span_s > 0 ? static_cast<double>(samples - 1) / span_s : 0;
  }
};

/// What is measured of a sample; nothing of the first one of an interval.
struct Quantity {
  const char* command;
  const char* name;  // in JSON, with its unit: "interval_s"
  const char* heading;
  double scale;  // from the unit of the JSON to that of the table
  const char* clock;
  std::optional<double> (*value)(const Row& before, const Arrival& arrival, std::int64_t stamp_ns);
};

std::optional<double> interval_s(const Row& before, const Arrival& arrival, std::int64_t) {
  if (before.samples == 0) return std::nullopt;
  return to_s(arrival.monotonic - before.last);
}

std::optional<double> delay_s(const Row&, const Arrival& arrival, std::int64_t stamp_ns) {
  return to_s(arrival.wall - from_ns(stamp_ns));
}

std::optional<double> size_B(const Row&, const Arrival& arrival, std::int64_t) {
  return static_cast<double>(arrival.cdr.size());
}

constexpr Quantity interval{"topic hz", "interval_s", "INTERVAL (monotonic clock), ms",
                            1e3,        "monotonic",  &interval_s};
constexpr Quantity delay{"topic delay", "delay_s", "DELAY (wall clock less stamp), ms", 1e3, "wall", &delay_s};
constexpr Quantity size{"topic bw", "size_B", "SIZE of a sample, bytes", 1, "monotonic", &size_B};

class Measuring {
 public:
  Measuring(const TopicOptions& options, const Quantity& quantity) : options_(options), quantity_(quantity) {}

  void add(const Arrival& arrival, const Decoded& sample) {
    Row& row = rows_[key_text(sample.key)];
    if (const auto value = quantity_.value(row, arrival, sample.stamp_ns)) {
      row.window.add(*value);
      row.all.add(*value);
    }
    if (row.samples == 0) {
      row.first = arrival.monotonic;
      row.first_stamp_ns = sample.stamp_ns;
    }
    ++row.samples;
    ++row.samples_in_window;
    row.last = arrival.monotonic;
    row.last_stamp_ns = sample.stamp_ns;
  }

  void print_window() {
    if (rows_.empty()) return;
    print_heading();
    for (auto& [key, row] : rows_) {
      print_row(key, static_cast<double>(row.samples_in_window) / options_.window_s, row.samples_in_window,
                row.window);
      row.window.clear();
      row.samples_in_window = 0;
    }
    std::fflush(stdout);
  }

  void print_total() {
    if (rows_.empty()) return;
    std::printf("over all:\n");
    heading_printed_ = false;
    print_heading();
    for (const auto& [key, row] : rows_) {
      print_row(key, row.rate_Hz(), row.samples, row.all);
      std::printf("%-24s   by stamps %.4g Hz\n", "", row.rate_by_stamps_Hz());
    }
  }

  Json metrics() const {
    Json metrics = Json::object();
    for (const auto& [key, row] : rows_) {
      const std::string prefix = rows_.size() > 1 ? key + ": " : "";
      const auto put = [&](const std::string& name, double value) { metrics[prefix + name] = value; };
      put("samples", static_cast<double>(row.samples));
      put("rate_Hz", row.rate_Hz());
      put("rate_by_stamps_Hz", row.rate_by_stamps_Hz());
      if (row.all.count() == 0) continue;
      const std::string name = quantity_.name;
      put(name + "_mean", row.all.mean());
      put(name + "_min", row.all.min());
      put(name + "_p50", row.all.quantile(0.5));
      put(name + "_p99", row.all.quantile(0.99));
      put(name + "_max", row.all.max());
      put(name + "_std", row.all.standard_deviation());
      if (quantity_.value == &size_B) put("bandwidth_B_s", row.rate_Hz() * row.all.mean());
    }
    return metrics;
  }

 private:
  void print_heading() {
    if (heading_printed_) return;
    heading_printed_ = true;
    std::printf("%-24s %9s %7s   %s\n%-24s %9s %7s %9s %9s %9s %9s %9s %9s%s\n", "", "", "", quantity_.heading, "KEY",
                "RATE, Hz", "SAMPLES", "MEAN", "MIN", "P50", "P99", "MAX", "STD",
                quantity_.value == &size_B ? "  BYTES/s" : "");
  }

  void print_row(const std::string& key, double rate_Hz, std::uint64_t samples, const MeasuredSeries& series) const {
    std::printf("%-24s %9.4g %7llu", key.empty() ? "-" : key.c_str(), rate_Hz,
                static_cast<unsigned long long>(samples));
    if (series.count() > 0) {
      for (const double value : {series.mean(), series.min(), series.quantile(0.5), series.quantile(0.99),
                                 series.max(), series.standard_deviation()}) {
        std::printf(" %9.4g", value * quantity_.scale);
      }
      if (quantity_.value == &size_B) std::printf(" %9.4g", rate_Hz * series.mean());
    }
    std::printf("\n");
  }

  const TopicOptions& options_;
  const Quantity& quantity_;
  std::map<std::string, Row> rows_;
  bool heading_printed_ = false;
};

int measure(const TopicOptions& options, const Quantity& quantity) {
  ok_or_throw(check_measurement_file(options.json_file));
  const TopicEntry& topic = find_topic(options.topic);
  // What is measured is the topic, not this tool: half a second of the fastest topic, 500 Hz, may wait for it.
  constexpr std::uint32_t depth = 256;
  Listener listener(options.ring, std::string("eciton ") + quantity.command, {&topic}, depth);
  Measuring measuring(options, quantity);
  const int status = listen(
      listener, topic, {.count = options.count, .seconds = options.seconds, .tick_s = options.window_s},
      [&](const Arrival& arrival, const Decoded& sample) { measuring.add(arrival, sample); },
      [&] { measuring.print_window(); });
  measuring.print_total();
  if (!options.json_file.empty()) {
    Measurement result{.command = quantity.command, .clock = quantity.clock};
    result.config = {{"topic", options.topic}, {"ring", listener.ring()}};
    result.metrics = measuring.metrics();
    ok_or_throw(write_measurement(options.json_file, result));
  }
  return status;
}

}  // namespace

int measure_rate(const TopicOptions& options) { return measure(options, interval); }
int measure_delay(const TopicOptions& options) { return measure(options, delay); }
int measure_bandwidth(const TopicOptions& options) { return measure(options, size); }

}  // namespace eciton::deploy
