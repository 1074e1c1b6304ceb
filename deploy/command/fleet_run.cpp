// Plans, claims, starts, and leaves nothing behind.
#include "deploy/command/fleet_run.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "deploy/hangup.hpp"
#include "deploy/net/net.hpp"
#include "deploy/supervisor/module_plan.hpp"

namespace eciton::deploy {
namespace {

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

}  // namespace

void run_fleet(const DemoOptions& given, runtime::StopFlag& stop, const FlyFleet& fly) {
  if (!given.dds.empty()) ::unsetenv("ECITON_DDS");  // what is asked for here counts more
  const DemoOptions options = value_or_throw(resolve(given));
  const DemoFleet fleet =
      value_or_throw(plan_demo(options, program_directory(), runtime_root(), running_net(options)));
  ok_or_throw(check_vendors(fleet.plans));

  const StopOnHangup on_hangup(stop);
  const IgnoredSignals ignored({SIGPIPE});  // children end by our hand also when nobody reads
  Launches launches = value_or_throw(claim_all(fleet.plans));
  write_files(fleet.files);
  start_fleet(fleet, launches);
  fly(options, fleet, launches);
  stop_all(launches);
  keep_logs(options, launches);
  launches.clear();
  if (fleet.own_net) ok_or_throw(net::take_down(fleet.own_net->name));  // nothing, unless its relay was killed
}

}  // namespace eciton::deploy
