// Flies and reports.
#include "deploy/command/demo.hpp"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "deploy/command/demo_flight.hpp"
#include "deploy/command/demo_report.hpp"
#include "deploy/command/fleet_run.hpp"

namespace eciton::deploy {
namespace {

/// A flight of minutes must not end with figures that cannot be written.
void check_output_paths(const DemoOptions& options) {
  if (options.json_file.empty()) return;
  const auto parent = std::filesystem::absolute(options.json_file).parent_path();
  if (::access(parent.c_str(), W_OK) != 0) {
    throw BadInput{
        {"--json " + options.json_file + ": directory " + parent.string() + " is not there or not writable"}};
  }
}

int fly_demo(const DemoOptions& given) {
  check_output_paths(given);
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  std::optional<FlightFailure> failure;
  run_fleet(given, stop, [&](const DemoOptions& options, const DemoFleet& fleet, Launches& launches) {
    DemoView view(stdout);
    if (options.hosts)
      view.say("on the radio of net " + options.net + "; disturb it with: eciton net set --name " + options.net +
               " delay=20ms loss=10%");
    DemoFlight flight(fleet, launches, stop, view);
    failure = flight.fly();
    if (failure && !failure->interrupted) print_failure(*failure, flight, launches);
    if (!failure) print_report(options, fleet, flight, launches);
    if (!options.json_file.empty()) {
      const Status written = write_measurement(options.json_file, demo_measurement(options, fleet, flight, launches));
      if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
    }
  });
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
