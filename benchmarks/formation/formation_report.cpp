// One row and one bar for each case.
#include "benchmarks/formation/formation_report.hpp"

#include <cmath>
#include <limits>

#include "benchmarks/statistics/summary.hpp"

namespace eciton::bench {
namespace {

constexpr std::array<const char*, 3> kinds{"view", "wrench", "skew"};

void add_formation(Result& result, const Samples& samples, Bars& bars) {
  if (samples.values.empty()) return;
  const Summary s = summarize(samples);
  const std::size_t dot = samples.name.find('.');
  const std::string what = samples.name.substr(0, dot), suffix = samples.name.substr(dot);
  result.metrics[what + "_ms_p50" + suffix] = s.p50;
  result.metrics[what + "_ms_p99" + suffix] = s.p99;
  result.metrics[what + "_ms_max" + suffix] = s.max;
  result.metrics[what + "_missing" + suffix] = samples.lost;
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  if (what == "wrench") bars.bars.push_back({"", suffix.substr(1), {nothing, s.p99, nothing}});
}

std::vector<std::string> idle_row(const DiscoveryCase& which, const DiscoveryCount& c) {
  const auto kbit_s = [&](std::uint64_t bytes) {
    return number_text(static_cast<double>(bytes) * 8e-3 / c.seconds / which.modules);
  };
  return {which.name(),
          kbit_s(c.discovery.bytes),
          kbit_s(c.participants.bytes),
          kbit_s(c.endpoints.bytes),
          kbit_s(c.liveliness.bytes),
          kbit_s(c.unreachable.bytes),
          kbit_s(c.beacons.bytes),
          kbit_s(c.topics.bytes - c.beacons.bytes),
          kbit_s(c.other.bytes),
          std::to_string(c.multicast.packets)};
}

std::vector<std::string> joining_row(const DiscoveryCase& which, const DiscoveryCount& c) {
  const auto kB = [](std::uint64_t bytes) { return number_text(static_cast<double>(bytes) * 1e-3); };
  return {which.name(),           kB(c.discovery.bytes), kB(c.participants.bytes), kB(c.endpoints.bytes),
          kB(c.liveliness.bytes), kB(c.topics.bytes),    kB(c.total.bytes),        std::to_string(c.total.packets)};
}

void add_metrics(Result& result, const DiscoveryCase& which, const DiscoveryFigures& figures) {
  const DiscoveryCount& idle = figures.idle;
  const auto bit_s = [&](std::uint64_t bytes) {
    return static_cast<double>(bytes) * 8 / idle.seconds / which.modules;
  };
  result.metrics["discovery_idle_bit_s." + which.name()] = bit_s(idle.discovery.bytes);
  result.metrics["beacons_idle_bit_s." + which.name()] = bit_s(idle.beacons.bytes);
  result.metrics["multicast_idle_packets." + which.name()] = idle.multicast.packets;
  result.metrics["discovery_joining_bytes." + which.name()] = figures.joining.discovery.bytes;
  result.metrics["all_joining_bytes." + which.name()] = figures.joining.total.bytes;
}

}  // namespace

std::string loss_name(double loss) { return std::to_string(std::lround(loss * 100)); }

FormationSamples::FormationSamples(const FormationCase& which, double loss)
    : name_(std::to_string(which.modules) + "." + loss_name(loss) + "." + which.pair.name()) {
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    samples_[k].name = kinds[k] + ("." + name_);
    samples_[k].unit = "ms";
    samples_[k].chart = std::string(kinds[k]) + " at " + loss_name(loss) + " % loss";
  }
}

void FormationSamples::add(double at_s, const std::optional<FormationTimes>& times) {
  for (Samples& samples : samples_) {
    ++samples.sent;
    samples.lost += times ? 0 : 1;
    if (times) samples.at_s.push_back(at_s);
  }
  if (!times) return;
  samples_[0].values.push_back(times->view_s * 1e3);
  samples_[1].values.push_back(times->wrench_s * 1e3);
  samples_[2].values.push_back(times->skew_s * 1e3);
}

void FormationSamples::mark_partial() {
  for (Samples& samples : samples_) samples.partial = true;
}

void FormationSamples::move_to(std::vector<Samples>& all) {
  for (Samples& samples : samples_) all.push_back(std::move(samples));
}

void add_formations(Result& result, std::vector<Samples> formations) {
  if (formations.empty()) return;
  result.tables.push_back(
      summary_table("From the latch to the chain that all members fly by, N.loss%.vendors", formations));
  Bars bars{.title = "From the latch to the first shared wrench of all members, p99",
            .unit = "ms",
            .bars = {},
            .limit = {}};
  for (const Samples& samples : formations) add_formation(result, samples, bars);
  result.bars.push_back(std::move(bars));
  result.samples = std::move(formations);
}

void add_discoveries(Result& result, const Discoveries& discoveries) {
  if (discoveries.empty()) return;
  Table idle{.title = "Discovery when all have met, per module (kbit/s)",
             .columns = {"", "discovery", "participants", "endpoints", "liveliness", "unreachable", "beacons",
                         "other topics", "other", "multicast packets"},
             .rows = {}};
  Table joining{.title = "When one more joins, all modules together (kB)",
                .columns = {"", "discovery", "participants", "endpoints", "liveliness", "topics", "all", "packets"},
                .rows = {}};
  for (const auto& [which, figures] : discoveries) {
    idle.rows.push_back(idle_row(which, figures.idle));
    joining.rows.push_back(joining_row(which, figures.joining));
    add_metrics(result, which, figures);
    if (figures.missed > 0) {
      result.notes.push_back("discovery, " + which.name() + ": " + std::to_string(figures.missed) +
                             " frames came faster than they were counted");
      result.partial = true;
    }
  }
  result.tables.push_back(std::move(idle));
  result.tables.push_back(std::move(joining));
}

}  // namespace eciton::bench
