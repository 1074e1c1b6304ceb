// Launch, fly, record. The pilot and the observer are participants of the module's ring, as any tool is.
#include "benchmarks/path/module_flight.hpp"

#include <sys/un.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "benchmarks/path/link_tap.hpp"
#include "benchmarks/path/ring_participants.hpp"
#include "core/base/wall_clock.hpp"
#include "core/bus/plugin_loader.hpp"
#include "deploy/module_config.hpp"
#include "deploy/supervisor/launch_loop.hpp"
#include "deploy/supervisor/module_plan.hpp"

namespace eciton::bench {
namespace {

namespace fs = std::filesystem;
constexpr Duration pace = std::chrono::milliseconds(20);
constexpr Duration start_timeout = std::chrono::seconds(40);
constexpr Duration hover_timeout = std::chrono::seconds(60);
constexpr Duration settle = std::chrono::seconds(1);
constexpr double ticks_per_s = 500;

struct Failure {
  std::string why;
};

fs::path program(const PathOptions& options, const std::string& name) {
  const fs::path file = options.programs / name;
  if (!fs::exists(file))
    throw BadInput{{"program " + file.string() + " is not there; build it, or give its directory"}};
  return file;
}

std::vector<std::string> module_assignments(const PathOptions& options, const FlightVariant& variant,
                                            const fs::path& directory) {
  std::vector<std::string> all{"id=" + std::to_string(options.module_id),
                               "name=bench",
                               "clock=wall",
                               "layout=" + std::string(variant.layout == "services" ? "services" : "composed"),
                               "dds=" + variant.vendor,
                               "realtime_priority=" + std::to_string(options.realtime_priority),
                               "hal.backend=sim",
                               "hal.socket=" + (directory / "board.sock").string()};
  all.insert(all.end(), options.assignments.begin(), options.assignments.end());
  return all;
}

std::string world_text(const PathOptions& options, const FlightVariant& variant, const fs::path& directory) {
  return "socket: " + (directory / "world.sock").string() + "\npace: wall\ntruth: false\ndds: " + variant.vendor +
         "\nworld:\n  seed: " + std::to_string(options.seed) +
         "\n  modules:\n    - {id: " + std::to_string(options.module_id) + "}\n";
}

struct Plan {
  deploy::LaunchPlan launch;
  ConfigTree module_tree;
  deploy::ModuleConfig config;
  fs::path directory, inside_file;
};

Plan plan(const PathOptions& options, const FlightVariant& variant) {
  Plan plan;
  plan.directory = deploy::runtime_root() / "bench";
  plan.inside_file = plan.directory / "inside";
  if ((plan.directory / "board.sock").string().size() >= sizeof(sockaddr_un::sun_path)) {
    throw BadInput{{"socket " + (plan.directory / "board.sock").string() +
                    ": the path is too long; set ECITON_RUNTIME_DIR to a shorter one"}};
  }
  const auto assignments = module_assignments(options, variant, plan.directory);
  plan.config = value_or_throw(deploy::load_module_config({}, assignments));
  for (const std::string& assignment : assignments) ok_or_throw(plan.module_tree.set(assignment, "--set"));
  const fs::path file = plan.directory / "module.yaml";
  plan.launch = deploy::plan_module(plan.config, file, {}, options.programs);
  auto& processes = plan.launch.processes;
  if (variant.layout == "one-process") {
    processes.resize(1);
    processes[0].name = processes[0].child.name = "module";
    processes[0].records_faults = processes[0].has_checkpoints = false;
    processes[0].child.arguments = {program(options, "eciton-bench-module"), "--config", file, "--inside",
                                    plan.inside_file};
  } else if (variant.layout == "services" && !options.whole_module) {
    std::erase_if(processes, [](const auto& process) {
      return process.name != "hardware" && process.name != "estimation" && process.name != "control";
    });
  }
  deploy::PlannedProcess world{.name = "world", .vendor = variant.vendor, .child = {}};
  world.child = {.name = "world",
                 .arguments = {program(options, "eciton-world"), "--config", plan.directory / "world.yaml"}};
  processes.insert(processes.begin(), world);
  for (auto& process : processes) process.child.environment = {{"ECITON_DDS", ""}};
  return plan;
}

void write_file(const fs::path& path, const std::string& text) {
  std::ofstream out(path);
  out << text;
  if (!out.flush()) throw Failure{"config " + path.string() + " cannot be written"};
}

/// The tap on a thread of its own; ends with its owner.
class TapThread {
 public:
  TapThread(TapConfig config, LinkTap::Hook hook) : tap_(std::move(config), std::move(hook)) {}
  ~TapThread() { join(); }
  Status start() {
    if (Status opened = tap_.open(); !opened) return opened;
    thread_ = std::thread([this] { tap_.run(stop_); });
    return ok();
  }
  void join() {
    stop_.request();
    if (thread_.joinable()) thread_.join();
  }
  LinkTap& tap() { return tap_; }

 private:
  runtime::StopFlag stop_;
  LinkTap tap_;
  std::thread thread_;
};

/// What the main thread does while the module flies.
class Watch {
 public:
  Watch(deploy::Launches& launches, const RunControl& control, Pilot& pilot)
      : launches_(launches), control_(control), pilot_(pilot) {}

  /// Looks after the processes until `done`; throws Failure when one of them ends, or after `timeout`.
  void until(const std::function<bool(Duration now)>& done, Duration timeout,
             const std::function<std::string()>& lacks = {}) {
    const Duration end = monotonic_now() + timeout;
    for (Duration now = monotonic_now(); !done(now); now = monotonic_now()) {
      deploy::watch(launches_, {control_.stop.file_descriptor()}, pace,
                    [](deploy::Launch& launch, const deploy::ChildReport& report) {
                      throw Failure{deploy::describe(launch, report)};
                    });
      if (control_.stop.requested()) throw Failure{"interrupted"};
      if (monotonic_now() > end) {
        throw Failure{(lacks ? lacks() : "not done") + " within " +
                      std::to_string(timeout / std::chrono::seconds(1)) + " s"};
      }
      pilot_.poll();
    }
  }

 private:
  deploy::Launches& launches_;
  const RunControl& control_;
  Pilot& pilot_;
};

std::vector<InsideSample> read_inside(const fs::path& file) {
  std::vector<InsideSample> samples;
  std::ifstream in(file, std::ios::binary);
  for (InsideSample s; in.read(reinterpret_cast<char*>(&s), sizeof s);) samples.push_back(s);
  return samples;
}

void fly_and_record(const PathOptions& options, const FlightVariant& variant, deploy::Launches& launches,
                    Pilot& pilot, LinkTap& tap, const RunControl& control,
                    const std::function<void(const std::string&)>& tell) {
  Watch watch(launches, control, pilot);
  tell(variant.name() + ": starting");
  watch.until([&](Duration) { return pilot.alive("control") && pilot.alive("estimation") && tap.passed() > 100; },
              start_timeout, [] { return "the services were not heard"; });
  tell(variant.name() + ": taking off");
  watch.until(
      [&](Duration now) {
        pilot.take_off(now);
        return pilot.hovers();
      },
      hover_timeout, [&] { return "no hover (" + pilot.last_answer() + ")"; });
  const Duration settled = monotonic_now() + settle;
  watch.until([&](Duration now) { return now >= settled; }, 2 * settle);
  tell(variant.name());
  tap.record(true);
  const Duration end = monotonic_now() + from_s(options.seconds);
  watch.until([&](Duration now) { return now >= end; }, from_s(options.seconds) + start_timeout);
  tap.record(false);
  if (!pilot.hovers()) throw Failure{"it did not stay in hover"};
}

}  // namespace

void check_variant(const PathOptions& options, const FlightVariant& variant) {
  if (variant.layout != "services" && variant.layout != "composed" && variant.layout != "one-process") {
    throw BadInput{{"no layout '" + variant.layout + "'; expected services, composed or one-process"}};
  }
  if (const auto plugin = bus::load_plugin(variant.vendor); !plugin) throw BadInput{plugin.error()};
  for (const auto& process : plan(options, variant).launch.processes) {
    static_cast<void>(program(options, fs::path(process.child.arguments[0]).filename()));
  }
}

FlightRecord fly(const PathOptions& options, const FlightVariant& variant, const RunControl& control,
                 const std::function<void(const std::string&)>& tell) {
  const Plan p = plan(options, variant);
  deploy::Launches launches = value_or_throw(deploy::claim_all({p.launch}));
  const auto ticks_max = static_cast<std::size_t>(1.2 * ticks_per_s * options.seconds) + 100;
  FlightRecord record;
  Pilot pilot(p.config.module_participant("pilot"), options.module_id);
  std::optional<RingObserver> observer;
  if (variant.staged()) observer.emplace(p.config.module_participant("observer"), 2 * ticks_max + 60'000);
  TapThread tap({.host_path = p.directory / "board.sock",
                 .world_path = p.directory / "world.sock",
                 .realtime_priority = options.realtime_priority,
                 .ticks_max = ticks_max},
                [&] {
                  if (observer) observer->poll();
                });
  try {
    write_file(p.directory / "module.yaml", p.module_tree.to_yaml());
    write_file(p.directory / "world.yaml", world_text(options, variant, p.directory));
    ok_or_throw(tap.start());
    ok_or_throw(deploy::start_all(launches));
    fly_and_record(options, variant, launches, pilot, tap.tap(), control, tell);
  } catch (const Failure& failure) {
    record.trouble = variant.name() + ": " + failure.why;
  } catch (const BadInput& bad) {
    record.trouble = variant.name() + ": " + bad.error.message;
  }
  deploy::stop_all(launches);
  tap.join();
  record.ticks = tap.tap().ticks();
  record.trace = observer ? trace_path(record.ticks, observer->seen()) : trace_link(record.ticks);
  record.inside = read_inside(p.inside_file);
  record.heartbeats = pilot.heartbeats();
  return record;
}

}  // namespace eciton::bench
