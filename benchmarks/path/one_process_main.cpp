// eciton-bench-module --config MODULE.yaml --inside FILE: hardware host, estimation and control of one module in one
// process and one thread, which a robot never flies by: what is left of the path without a network between them.
#include <CLI/CLI.hpp>
#include <fstream>
#include <optional>
#include <vector>

#include "benchmarks/path/path_trace.hpp"
#include "core/base/log.hpp"
#include "core/base/wall_clock.hpp"
#include "core/runtime/realtime_thread.hpp"
#include "core/runtime/service_group.hpp"
#include "core/runtime/stop_signal.hpp"
#include "deploy/module.hpp"
#include "deploy/program.hpp"
#include "hal/sim/make_devices.hpp"
#include "hal/sim/socket_link.hpp"

namespace {

using namespace eciton;

constexpr Duration connect_timeout = std::chrono::seconds(30);
constexpr std::size_t samples_max = 2'000'000;

class WholeModule {
 public:
  explicit WholeModule(const deploy::ModuleConfig& config)
      : airframe_(deploy::make_airframe(config)),
        link_(value_or_throw(hal::sim::SocketLink::connect(config.hal.socket, config.id, connect_timeout))),
        devices_(hal::sim::make_devices(link_->board(), airframe_)),
        ring_(config.module_participant("module")),
        sense_(ring_, {.module_id = config.id}, devices_),
        estimation_(deploy::make_service("estimation", config, ring_, nullptr)),
        control_(deploy::make_service("control", config, ring_, nullptr)),
        act_(ring_, {.module_id = config.id}, airframe_, devices_),
        group_({.module_id = config.id, .process = "module"}, {&ring_}, runtime::ServiceGroup::Pacing::wall_clock) {
    for (runtime::Service* service : {static_cast<runtime::Service*>(&sense_), estimation_.get(), control_.get(),
                                      static_cast<runtime::Service*>(&act_)}) {
      group_.add(*service);
    }
    group_.mute();  // readings alone wake this process
    deploy::bring_up(devices_);
    inside_.reserve(samples_max);
  }

  void run(const runtime::StopFlag& stop) {
    group_.start(monotonic_now());
    while (!stop.requested()) {
      const hal::Io io = link_->wait_sensors(std::chrono::milliseconds(100));
      if (io == hal::Io::error) return;
      if (io == hal::Io::ok) tick();
    }
  }

  void write_inside(const std::string& path) const {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(inside_.data()),
              static_cast<std::streamsize>(inside_.size() * sizeof inside_[0]));
  }

 private:
  void tick() {
    const std::int64_t in_ns = to_ns(wall_now());
    Duration at = monotonic_now();
    for (const auto& entry : group_.entries()) {
      const bool sense = entry->service == &sense_;
      if (sense || group_.due(*entry, at)) at = group_.step(*entry, at, wall_now());
    }
    if (inside_.size() < samples_max) inside_.push_back({in_ns, to_ns(wall_now())});
    link_->act();
    group_.beat_if_due(at, wall_now());
  }

  robot::Airframe airframe_;
  std::unique_ptr<hal::sim::SocketLink> link_;
  hal::Devices devices_;
  bus::Participant ring_;
  hal::SenseService sense_;
  std::unique_ptr<runtime::Service> estimation_, control_;
  hal::ActService act_;
  runtime::ServiceGroup group_;
  std::vector<bench::InsideSample> inside_;
};

int run(int argc, char** argv) {
  CLI::App app("A module in one process, for measuring.");
  std::string config_file, inside_file;
  app.add_option("--config", config_file, "the module's config")->required();
  app.add_option("--inside", inside_file, "where to write when readings came and commands left")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& e) {
    throw BadInput{{e.what()}};
  }
  const deploy::ModuleConfig config = value_or_throw(deploy::load_module_config({config_file}, {}));
  start_log(config.name + "/module");
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  WholeModule module(config);
  if (config.realtime_priority > 0) {
    if (const auto missing = runtime::make_realtime(config.realtime_priority)) spdlog::warn("{}", *missing);
  }
  module.run(stop);
  module.write_inside(inside_file);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return eciton::deploy::run_program("eciton-bench-module", [&] { return run(argc, argv); });
}
