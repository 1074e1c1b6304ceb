// Truth first, estimate beside it.
#include "deploy/command/demo_report.hpp"

#include <algorithm>
#include <cstdio>

namespace eciton::deploy {
namespace {

constexpr std::size_t log_lines = 6;

Spread over(const std::map<DemoPhase, Spread>& figures, std::initializer_list<DemoPhase> phases) {
  Spread sum;
  for (const DemoPhase phase : phases) {
    const auto found = figures.find(phase);
    if (found == figures.end()) continue;
    sum.count += found->second.count;
    sum.sum += found->second.sum;
    sum.max = std::max(sum.max, found->second.max);
  }
  return sum;
}

constexpr std::initializer_list<DemoPhase> as_one_body{DemoPhase::assembled, DemoPhase::morphing};

/// One process, or one service of a composed one.
struct Row {
  std::string process;
  std::string vendor;
  std::uint32_t pid = 0;
  const msg::Heartbeat* beat = nullptr;  // none of the world
};

std::vector<Row> rows(const DemoFlight& flight, const Launches& launches) {
  std::vector<Row> result;
  for (const auto& launch : launches) {
    const LaunchPlan& plan = launch->plan();
    if (plan.module_id != 0) continue;
    result.push_back({plan.processes[0].name, plan.processes[0].vendor,
                      static_cast<std::uint32_t>(launch->supervisor().reports()[0].pid)});
  }
  for (const auto& ear : flight.ears()) {
    for (const auto& [service, beat] : ear->heartbeats()) {
      result.push_back(
          {"m" + std::to_string(ear->id()) + "/" + service, std::string(beat.vendor.view()), beat.pid, &beat});
    }
  }
  return result;
}

void print_spread(const char* what, const char* unit, const Spread& truth, const Spread* estimated) {
  std::printf("  %-34s %9.4f %9.4f %-3s", what, truth.mean(), truth.max, unit);
  if (estimated != nullptr) std::printf("   estimated %9.4f %9.4f %s", estimated->mean(), estimated->max, unit);
  std::printf("\n");
}

void print_processes(const DemoFlight& flight, const Launches& launches) {
  std::printf("\n  %-16s %-11s %8s %9s %10s %10s %10s %10s %9s\n", "PROCESS", "VENDOR", "PID", "CYCLES", "PERIOD ms",
              "JITTER us", "EXEC us", "MAX us", "OVERRUNS");
  for (const Row& row : rows(flight, launches)) {
    std::printf("  %-16s %-11s %8u", row.process.c_str(), row.vendor.c_str(), row.pid);
    if (row.beat != nullptr) {
      std::printf(" %9llu %10.2f %10.0f %10.0f %10.0f %9llu", static_cast<unsigned long long>(row.beat->cycles),
                  1e3 * row.beat->period_s, 1e6 * row.beat->jitter_s_p99, 1e6 * row.beat->execution_s_mean,
                  1e6 * row.beat->execution_s_max, static_cast<unsigned long long>(row.beat->overruns));
    }
    std::printf("\n");
  }
}

std::size_t process_count(const DemoFleet& fleet) {
  std::size_t count = 0;
  for (const LaunchPlan& plan : fleet.plans) count += plan.processes.size();
  return count;
}

}  // namespace

void print_report(const DemoOptions& options, const DemoFleet& fleet, const DemoFlight& flight,
                  const Launches& launches) {
  const DemoResult& result = flight.result();
  const DemoFigures& figures = result.figures;
  std::printf("\n%u modules, %zu processes, %s, %s clock, %s, seed %llu\n", options.modules, process_count(fleet),
              options.dds.c_str(), options.clock.c_str(), options.layout.c_str(),
              static_cast<unsigned long long>(options.seed));
  std::printf("flown %.1f s in %.1f s: %.2f x real time\n\n", result.simulated_s, result.wall_s,
              result.wall_s > 0 ? result.simulated_s / result.wall_s : 0);
  for (const DockingRecord& docking : result.dockings) {
    std::printf("  docking %u to %u %25.2f s, declared by %s, %u recoveries\n", docking.follower, docking.target,
                docking.time_s, docking.declared_by.c_str(), docking.recoveries);
  }
  std::printf("\n  %-34s %9s %9s\n", "", "mean", "max");
  const Spread estimated = over(figures.contact_force_N_estimated, as_one_body);
  print_spread("contact force, as one body", "N", over(figures.contact_force_N, as_one_body), &estimated);
  print_spread("contact torque, as one body", "Nm", over(figures.contact_moment_Nm, as_one_body), nullptr);
  print_spread("contact force, while docking", "N", over(figures.contact_force_N, {DemoPhase::docking}), nullptr);
  print_spread("tracking error, hovering", "m", figures.tracking_error_m, nullptr);
  print_spread("estimation error", "m", figures.estimation_error_m, nullptr);
  print_processes(flight, launches);
  std::fflush(stdout);
}

Measurement demo_measurement(const DemoOptions& options, const DemoFleet& fleet, const DemoFlight& flight,
                             const Launches& launches) {
  const DemoResult& result = flight.result();
  const DemoFigures& figures = result.figures;
  Measurement m{.command = "demo", .clock = options.clock == "lockstep" ? "simulated" : "wall"};
  m.config = {{"modules", options.modules}, {"dds", options.dds},         {"clock", options.clock},
              {"layout", options.layout},   {"set", options.assignments}, {"processes", process_count(fleet)}};
  m.seed = options.seed;
  Spread docking;
  m.series["docking_follower"] = Json::array();
  m.series["docking_time_s"] = Json::array();
  for (const DockingRecord& record : result.dockings) {
    docking.add(record.time_s);
    m.series["docking_follower"].push_back(record.follower);
    m.series["docking_time_s"].push_back(record.time_s);
  }
  const auto put = [&](const std::string& name, const Spread& spread) {
    m.metrics[name + "_mean"] = spread.mean();
    m.metrics[name + "_max"] = spread.max;
  };
  m.metrics["dockings"] = docking.count;
  put("docking_time_s", docking);
  put("contact_force_N", over(figures.contact_force_N, as_one_body));
  put("contact_torque_Nm", over(figures.contact_moment_Nm, as_one_body));
  const Spread estimated = over(figures.contact_force_N_estimated, as_one_body);
  m.metrics["contact_force_N_mean_estimated"] = estimated.mean();
  m.metrics["contact_force_N_max_estimated"] = estimated.max;
  m.metrics["docking_force_N_max"] = over(figures.contact_force_N, {DemoPhase::docking}).max;
  put("tracking_error_m", figures.tracking_error_m);
  put("estimation_error_m", figures.estimation_error_m);
  m.metrics["assembled"] = result.assembled ? 1 : 0;
  m.metrics["morphed"] = result.morphed ? 1 : 0;
  m.metrics["separated"] = result.separated ? 1 : 0;
  m.metrics["simulated_s"] = result.simulated_s;
  m.metrics["wall_s"] = result.wall_s;
  for (const char* column : {"process", "vendor", "pid", "cycles", "period_s", "jitter_s_p99", "overruns"}) {
    m.series[column] = Json::array();
  }
  for (const Row& row : rows(flight, launches)) {
    if (row.beat == nullptr) continue;
    m.series["process"].push_back(row.process);
    m.series["vendor"].push_back(row.vendor);
    m.series["pid"].push_back(row.pid);
    m.series["cycles"].push_back(row.beat->cycles);
    m.series["period_s"].push_back(row.beat->period_s);
    m.series["jitter_s_p99"].push_back(row.beat->jitter_s_p99);
    m.series["overruns"].push_back(row.beat->overruns);
  }
  return m;
}

void print_failure(const FlightFailure& failure, const DemoFlight& flight, const Launches& launches) {
  std::fprintf(stderr, "\nthe demo failed at: %s\n  %s\n", failure.step.c_str(), failure.why.c_str());
  for (const std::string& fault : flight.faults()) std::fprintf(stderr, "  fault: %s\n", fault.c_str());
  for (const auto& launch : launches) {
    for (const PlannedProcess& process : launch->plan().processes) {
      const std::string name = launch->plan().name + "/" + process.name;
      if (!failure.processes.contains(name)) continue;
      const auto lines = last_lines(launch->supervisor().log_file(process.name), log_lines);
      if (lines.empty()) continue;
      std::fprintf(stderr, "  log of %s:\n", name.c_str());
      for (const std::string& line : lines) std::fprintf(stderr, "    %s\n", line.c_str());
    }
  }
}

}  // namespace eciton::deploy
