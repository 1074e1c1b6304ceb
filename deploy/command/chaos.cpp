// Flight after flight, and a table of what the faults did.
#include "deploy/command/chaos.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

#include "core/base/wall_clock.hpp"
#include "deploy/command/chaos_flight.hpp"
#include "deploy/command/fleet_run.hpp"
#include "deploy/command/measurement.hpp"
#include "deploy/report/statistics.hpp"

namespace eciton::deploy {
namespace {

constexpr std::size_t random_cells_least = 12;  // of one flight
constexpr double cell_s = 12;                   // a blow and what follows, about
constexpr const char* net_name = "eciton-chaos";
constexpr const char* disk_path = "/run/eciton-chaos";

struct ChaosOptions {
  std::uint32_t modules = 2;
  double minutes = 0;
  bool matrix = false;
  bool pairwise = false;
  std::string dds;
  std::uint64_t seed = 1;
  std::string keep_logs, json_file;
};

/// All that was flown so far.
struct ChaosTally {
  std::vector<ChaosOutcome> outcomes;
  std::vector<std::string> failures;  // flights that did not come to their end
  std::vector<std::string> left;      // by flights, when they had ended
  double memory_growth_share_max = 0;
  bool interrupted = false;
};

void print_head() {
  std::printf("%-38s %-11s %9s %11s %11s %12s\n", "FAULT", "VENDORS", "BACK s", "SETTLED s", "LOWEST m",
              "DEVIATION m");
}

void print_outcome(const ChaosOutcome& o) {
  std::printf("%-38s %-11s %9.2f", o.cell.text().c_str(), o.vendor.c_str(), o.back_s);
  if (o.cell.stage == FlightStage::approach) {
    std::printf(" %11s", "-");
  } else {
    std::printf(" %11.2f", o.settled_s);
  }
  std::printf(" %11.2f %12.2f", o.height_m_min, o.deviation_m_max);
  for (const std::string& bound : o.broken) std::printf("  %s", bound.c_str());
  std::printf("\n");
  std::fflush(stdout);
}

void note_growth(const MemoryGrowth::Most& most, ChaosTally& tally) {
  if (most.process.empty()) return;
  std::printf("memory of %s grew by %.1f %%, the others' by less\n", most.process.c_str(), 100 * most.share);
  tally.memory_growth_share_max = std::max(tally.memory_growth_share_max, most.share);
}

void fly_plan(const ChaosOptions& options, const ChaosPlan& plan, runtime::StopFlag& stop, ChaosTally& tally) {
  DemoOptions fleet_options{.modules = options.modules, .dds = plan.dds, .layout = "services", .seed = options.seed};
  fleet_options.hosts = true;
  fleet_options.net = net_name;
  fleet_options.keep_logs = options.keep_logs;
  const SmallDisk disk(disk_path);
  const std::set<std::string> shared_memory = shared_memory_files();
  run_fleet(fleet_options, stop, [&](const DemoOptions&, const DemoFleet& fleet, Launches& launches) {
    DemoView view(stderr);
    const net::NetSpec net = fleet.own_net.value_or(net::NetSpec{.name = net_name, .modules = options.modules});
    ChaosFlight flight(fleet, launches, stop, view, FaultInjector(net, disk.path(), launches), plan);
    const std::optional<FlightFailure> failure = flight.fly();
    tally.outcomes.insert(tally.outcomes.end(), flight.outcomes().begin(), flight.outcomes().end());
    tally.interrupted = failure && failure->interrupted;
    note_growth(flight.memory_growth(), tally);
    if (failure && !failure->interrupted)
      tally.failures.push_back(plan.dds + ", " + failure->step + ": " + failure->why);
    for (const ChaosOutcome& outcome : flight.outcomes()) print_outcome(outcome);
    if (!failure || failure->interrupted) return;
    std::printf("%s: %s\n", failure->step.c_str(), failure->why.c_str());
    for (const std::string& fault : flight.faults()) std::printf("  %s\n", fault.c_str());
  });
  const auto left = [&](std::size_t count, const char* what) {
    if (count == 0) return;
    tally.left.push_back(plan.dds + " left " + std::to_string(count) + " " + what);
    std::printf("%s\n", tally.left.back().c_str());
  };
  left(disk.users().size(), "processes");
  std::size_t files = 0;
  for (const std::string& name : shared_memory_files()) files += shared_memory.contains(name) ? 0 : 1;
  left(files, "files in /dev/shm");
}

Measurement measurement(const ChaosOptions& options, const ChaosTally& tally) {
  Measurement out{.command = "chaos", .clock = "monotonic"};
  out.config = {{"modules", options.modules},
                {"minutes", options.minutes},
                {"matrix", options.matrix},
                {"pairwise", options.pairwise},
                {"dds", options.dds}};
  out.seed = options.seed;
  std::size_t violations = tally.failures.size() + tally.left.size();
  double lowest_m = 1e9, deviation_m = 0;
  std::map<std::string, std::vector<double>> back_s;
  Json cells = Json::array();
  for (const ChaosOutcome& o : tally.outcomes) {
    violations += o.broken.size();
    lowest_m = std::min(lowest_m, o.height_m_min);
    deviation_m = std::max(deviation_m, o.deviation_m_max);
    back_s[name_of(o.cell.kind)].push_back(o.back_s);
    cells.push_back({{"fault", o.cell.text()},
                     {"vendors", o.vendor},
                     {"back_s", o.back_s},
                     {"settled_s", o.settled_s},
                     {"height_m_min", o.height_m_min},
                     {"deviation_m_max", o.deviation_m_max},
                     {"broken", o.broken}});
  }
  out.metrics = {
      {"cells", tally.outcomes.size()}, {"violations", violations}, {"flights_not_ended", tally.failures.size()}};
  out.metrics["left_behind"] = tally.left.size();
  out.metrics["memory_growth_share_max"] = tally.memory_growth_share_max;
  if (!tally.outcomes.empty()) {
    out.metrics["height_m_min"] = lowest_m;
    out.metrics["deviation_m_max"] = deviation_m;
  }
  for (auto& [kind, values] : back_s) {
    std::sort(values.begin(), values.end());
    out.metrics[kind + "_back_s_p50"] = report::quantile_of_sorted(values, 0.5);
    out.metrics[kind + "_back_s_p99"] = report::quantile_of_sorted(values, 0.99);
  }
  out.series = {{"cells", cells}, {"failures", tally.failures}, {"left", tally.left}};
  return out;
}

int run_chaos(const ChaosOptions& options) {
  if (options.matrix + options.pairwise + (options.minutes > 0) != 1) {
    throw BadInput{{"chaos: one of --matrix, --pairwise and --minutes M over zero is wanted"}};
  }
  ok_or_throw(check_measurement_file(options.json_file));
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  ChaosTally tally;
  print_head();
  if (options.minutes > 0) {
    std::mt19937_64 random(options.seed);
    // One flight for each choice of vendors, as long as the time allows: what leaks shows late.
    const double flights = options.dds.empty() ? static_cast<double>(vendor_choices.size()) : 1;
    const std::size_t cells =
        std::max(random_cells_least, static_cast<std::size_t>(60 * options.minutes / flights / cell_s));
    const Duration end = monotonic_now() + from_s(60 * options.minutes);
    for (std::size_t flight = 0; monotonic_now() < end && !tally.interrupted; ++flight) {
      const std::string dds = options.dds.empty() ? vendor_choices[flight % vendor_choices.size()] : options.dds;
      fly_plan(options, random_plan(dds, options.modules, cells, random), stop, tally);
    }
  } else {
    for (const ChaosPlan& plan : options.matrix ? full_matrix(options.modules) : pairwise_matrix(options.modules)) {
      if (tally.interrupted) break;
      if (options.dds.empty() || options.dds == plan.dds) fly_plan(options, plan, stop, tally);
    }
  }
  const Measurement measured = measurement(options, tally);
  if (!options.json_file.empty()) ok_or_throw(write_measurement(options.json_file, measured));
  std::printf("\n%zu faults, %d bounds broken\n", tally.outcomes.size(),
              measured.metrics.at("violations").get<int>());
  if (tally.interrupted) return interrupted_status;
  return measured.metrics.at("violations").get<int>() == 0 ? 0 : 1;
}

}  // namespace

void add_chaos(CLI::App& app, Run& run) {
  const auto options = std::make_shared<ChaosOptions>();
  CLI::App* sub = app.add_subcommand("chaos", "strike flying modules with faults, and see that they fly on");
  sub->add_option("--modules", options->modules, "how many")->check(CLI::Range(2, 8))->capture_default_str();
  sub->add_option("--minutes", options->minutes, "random faults for so long, whole flights")
      ->check(CLI::PositiveNumber);
  sub->add_flag("--matrix", options->matrix, "every fault on every process, at every stage, with every vendor");
  sub->add_flag("--pairwise", options->pairwise, "a selection in which every pair of these appears");
  sub->add_option("--dds", options->dds, "only this choice of vendors")
      ->check(CLI::IsMember({"cyclonedds", "fastdds", "mixed"}));
  sub->add_option("--seed", options->seed, "of the faults and of the world")->capture_default_str();
  sub->add_option("--keep-logs", options->keep_logs, "copy the processes' logs to this directory at the end");
  sub->add_option("--json", options->json_file, "write the figures to this file as well");
  on_chosen(*sub, run, [options] { return run_chaos(*options); });
}

}  // namespace eciton::deploy
