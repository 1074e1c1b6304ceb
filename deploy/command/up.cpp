// Checks everything, claims everything, then starts; what is bad input to a process ends the whole start.
#include "deploy/command/up.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <set>

#include "core/base/wall_clock.hpp"
#include "core/runtime/stop_signal.hpp"
#include "core/runtime/watchdog.hpp"
#include "deploy/command/detach.hpp"
#include "deploy/hangup.hpp"
#include "deploy/module_config.hpp"
#include "deploy/supervisor/launch_loop.hpp"
#include "deploy/supervisor/module_plan.hpp"
#include "deploy/world_file.hpp"

namespace eciton::deploy {
namespace {

struct UpOptions {
  std::vector<std::string> files;
  std::vector<std::string> assignments;
  std::string world_file;
  bool detach = false;
};

constexpr Duration start_phase = std::chrono::seconds(2);  // in which a process says that its input is bad
constexpr Duration pace = std::chrono::milliseconds(20);   // at which it looks for signs of life
constexpr int bad_input_status = 2;

std::vector<LaunchPlan> plan_all(const UpOptions& options) {
  namespace fs = std::filesystem;
  const fs::path programs = program_directory();
  std::vector<LaunchPlan> plans;
  if (!options.world_file.empty()) {
    ConfigTree tree;
    ok_or_throw(tree.add_file(options.world_file));
    WorldFile config;
    ok_or_throw(read_config(tree, config));
    LaunchPlan world{.name = "world", .network_interface = {}, .claims = {}, .processes = {}};
    world.processes.push_back({.name = "world", .vendor = config.dds, .child = {}});
    world.processes[0].child = {
        .name = "world", .arguments = {programs / "eciton-world", "--config", fs::absolute(options.world_file)}};
    plans.push_back(std::move(world));
  }
  std::vector<ModuleConfig> configs;
  for (const std::string& file : options.files) {
    configs.push_back(value_or_throw(load_module_config({file}, options.assignments)));
    plans.push_back(plan_module(configs.back(), fs::absolute(file), options.assignments, programs));
  }
  ok_or_throw(check_distinct(configs, options.files));
  return plans;
}

/// Until all have lived through it: true. A process that calls its input bad: BadInput. A stop: false.
bool live_through_start(Launches& launches, const runtime::StopFlag& stop) {
  const Duration end = monotonic_now() + start_phase;
  while (monotonic_now() < end) {
    if (stop.requested()) return false;
    watch(launches, {stop.file_descriptor()}, pace, [](Launch& launch, const ChildReport& report) {
      if (report.state == ChildState::refused) throw BadInput{{describe(launch, report)}};
      std::fprintf(stderr, "%s; it is started again\n", describe(launch, report).c_str());
    });
  }
  return true;
}

void print_started(const Launches& launches) {
  for (const auto& launch : launches) {
    std::printf("%s is up:", launch->plan().name.c_str());
    for (const ChildReport& report : launch->supervisor().reports()) {
      std::printf(" %s %d", report.name.c_str(), static_cast<int>(report.pid));
    }
    std::printf("\n  logs in %s\n", launch->directory().c_str());
  }
  std::fflush(stdout);
}

/// What a process calls bad input when it starts ends the whole of its module: nothing stays half-started. When
/// it does so only at a restart, the others fly on.
int run_until_stopped(Launches& launches, const runtime::StopFlag& stop) {
  int status = 0;
  runtime::LoopProgress turns;
  // Under systemd it is watched as it watches the others.
  const runtime::Watchdog watchdog([&] {
    if (!turns.has_turned()) return std::string_view("up");
    turns.note();
    return std::string_view();
  });
  while (!stop.requested() && !launches.empty()) {
    turns.turn();
    std::set<const Launch*> half_started;
    watch(launches, {stop.file_descriptor()}, pace, [&](Launch& launch, const ChildReport& report) {
      const bool refused = report.state == ChildState::refused;
      if (refused && report.restarts == 0) half_started.insert(&launch);
      std::fprintf(stderr, "%s; %s\n", describe(launch, report).c_str(),
                   !refused               ? "it is started again"
                   : report.restarts == 0 ? "all of it ends"
                                          : "it stays down until the config is mended and all of it is up anew");
    });
    if (!half_started.empty()) status = bad_input_status;
    std::erase_if(launches, [&](const auto& launch) {
      return launch->stop_requested() || half_started.contains(launch.get());
    });
  }
  stop_all(launches);
  return status;
}

int bring_up(const UpOptions& options) {
  Detached detached = options.detach ? Detached::fork() : Detached();
  if (detached.is_parent()) return detached.wait_for_start();
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  // A robot does not stop because the session that started it drops, or nobody reads any more.
  const IgnoredSignals ignored({SIGHUP, SIGPIPE});
  try {
    const std::vector<LaunchPlan> plans = plan_all(options);
    ok_or_throw(check_vendors(plans));
    Launches launches = value_or_throw(claim_all(plans));
    ok_or_throw(start_all(launches));
    if (!live_through_start(launches, stop)) return 0;
    print_started(launches);
    detached.report_started();
    return run_until_stopped(launches, stop);
  } catch (const BadInput& bad) {
    detached.report_failure(bad.error.message);
    throw;
  }
}

}  // namespace

void add_up(CLI::App& app, Run& run) {
  const auto options = std::make_shared<UpOptions>();
  CLI::App* sub = app.add_subcommand(
      "up", "run the processes of modules, restarting what ends or hangs, also when the terminal hangs up");
  sub->add_option("MODULE.yaml", options->files, "one file per module")->required();
  sub->add_option("--world", options->world_file, "a simulated world for them, as eciton-world takes it");
  sub->add_option("--set", options->assignments, "key=value, over all the files")->allow_extra_args(false);
  sub->add_flag("--detach", options->detach, "go on in the background; 'eciton down' ends it");
  on_chosen(*sub, run, [options] { return bring_up(*options); });
}

}  // namespace eciton::deploy
