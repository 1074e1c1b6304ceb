// Plans, claims, starts, flies, reports, and leaves nothing behind.
#include "deploy/command/demo.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "core/runtime/stop_signal.hpp"
#include "deploy/command/demo_fleet.hpp"
#include "deploy/command/demo_flight.hpp"
#include "deploy/command/demo_report.hpp"
#include "deploy/command/demo_view.hpp"
#include "deploy/hangup.hpp"
#include "deploy/net/net.hpp"
#include "deploy/supervisor/module_plan.hpp"

namespace eciton::deploy {
namespace {

constexpr int interrupted_status = 130;

void write_files(const std::vector<DemoFile>& files) {
  for (const DemoFile& file : files) {
    std::ofstream out(file.path);
    out << file.text;
    if (!out.flush()) throw BadInput{{"config " + file.path.string() + " cannot be written"}};
  }
}

void keep_logs(const DemoOptions& options, const Launches& launches) {
  if (options.keep_logs.empty()) return;
  for (const auto& launch : launches) {
    if (const Status status = launch->keep_logs(options.keep_logs); !status) {
      std::fprintf(stderr, "%s\n", status.error().message.c_str());
    }
  }
}

/// A flight of minutes must not end with figures that cannot be written.
void check_output_paths(const DemoOptions& options) {
  if (options.json_file.empty()) return;
  const auto parent = std::filesystem::absolute(options.json_file).parent_path();
  if (::access(parent.c_str(), W_OK) != 0) {
    throw BadInput{
        {"--json " + options.json_file + ": directory " + parent.string() + " is not there or not writable"}};
  }
}

/// Before anything starts: rights, and the net of that name if it is up.
std::optional<net::NetSpec> running_net(const DemoOptions& options) {
  if (!options.hosts) return std::nullopt;
  ok_or_throw(net::check_rights());
  for (const net::KnownNet& known : net::known_nets()) {
    if (known.up && known.spec.name == options.net) return known.spec;
  }
  return std::nullopt;
}

/// The net first: its hosts are where the others start.
void start_fleet(const DemoFleet& fleet, Launches& launches) {
  Launch* relay = fleet.own_net ? launches.back().get() : nullptr;
  if (relay != nullptr) {
    ok_or_throw(relay->start());
    while (!net::wait_until_up(fleet.own_net->name, std::chrono::milliseconds(20))) {
      relay->check([&](const ChildReport& report) { throw BadInput{{describe(*relay, report)}}; });
    }
  }
  for (const auto& launch : launches) {
    if (launch.get() != relay) ok_or_throw(launch->start());
  }
}

int fly_demo(const DemoOptions& given) {
  if (!given.dds.empty()) ::unsetenv("ECITON_DDS");  // what is asked for here counts more
  const DemoOptions options = value_or_throw(resolve(given));
  const DemoFleet fleet =
      value_or_throw(plan_demo(options, program_directory(), runtime_root(), running_net(options)));
  ok_or_throw(check_vendors(fleet.plans));
  check_output_paths(options);

  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  const StopOnHangup on_hangup(stop);
  const IgnoredSignals ignored({SIGPIPE});  // children end by our hand also when nobody reads
  Launches launches = value_or_throw(claim_all(fleet.plans));
  write_files(fleet.files);
  start_fleet(fleet, launches);
  DemoView view(stdout);
  if (options.hosts)
    view.say("on the radio of net " + options.net + "; disturb it with: eciton net set --name " + options.net +
             " delay=20ms loss=10%");
  std::optional<DemoFailure> failure;
  {
    DemoFlight flight(fleet, launches, stop, view);
    failure = flight.fly();
    if (failure && !failure->interrupted) print_failure(*failure, flight, launches);
    if (!failure) print_report(options, fleet, flight, launches);
    if (!options.json_file.empty()) {
      const Status written = write_measurement(options.json_file, demo_measurement(options, fleet, flight, launches));
      if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
    }
  }
  stop_all(launches);
  keep_logs(options, launches);
  launches.clear();
  if (fleet.own_net) ok_or_throw(net::take_down(fleet.own_net->name));  // nothing, unless its relay was killed
  if (!failure) return 0;
  if (failure->interrupted) std::fprintf(stderr, "interrupted: everything is down\n");
  return failure->interrupted ? interrupted_status : 1;
}

}  // namespace

void add_demo(CLI::App& app, Run& run) {
  const auto options = std::make_shared<DemoOptions>();
  CLI::App* sub = app.add_subcommand("demo", "modules dock in flight, morph and separate, in a simulated world");
  sub->add_option("--modules", options->modules, "how many")->check(CLI::Range(2, 8))->capture_default_str();
  sub->add_option(
         "--dds", options->dds,
         "cyclonedds, fastdds, or mixed: they alternate between processes (default: ECITON_DDS, else cyclonedds)")
      ->check(CLI::IsMember({"cyclonedds", "fastdds", "mixed"}));
  sub->add_option("--clock", options->clock,
                  "lockstep: as fast as the machine goes; wall: in real time (default: lockstep; with --hosts wall)")
      ->check(CLI::IsMember({"lockstep", "wall"}));
  sub->add_option("--layout", options->layout,
                  "services: a process each; composed: one for all of a module's (default: services; with --hosts "
                  "composed)")
      ->check(CLI::IsMember({"services", "composed"}));
  sub->add_flag("--hosts", options->hosts,
                "every module in a host of its own, on a radio that 'eciton net set' disturbs");
  sub->add_option("--net", options->net, "with --hosts: the net's name; one that is up is used as it is")
      ->capture_default_str();
  sub->add_option("--seed", options->seed, "of the world")->capture_default_str();
  sub->add_option("--set", options->assignments, "key=value, of the modules' configs or of the world's")
      ->allow_extra_args(false);
  sub->add_option("--keep-logs", options->keep_logs, "copy the processes' logs to this directory at the end");
  sub->add_option("--json", options->json_file, "write the figures to this file as well");
  on_chosen(*sub, run, [options] { return fly_demo(*options); });
}

}  // namespace eciton::deploy
