// eciton-service --config MODULE.yaml NAME...: one service of a module, or several composed in one process.
#include <memory>
#include <optional>
#include <vector>

#include "core/base/log.hpp"
#include "core/base/wall_clock.hpp"
#include "core/runtime/interface_watch.hpp"
#include "core/runtime/lockstep_executor.hpp"
#include "core/runtime/realtime_executor.hpp"
#include "core/runtime/realtime_thread.hpp"
#include "core/runtime/watchdog.hpp"
#include "deploy/module.hpp"
#include "deploy/program.hpp"

namespace {

using namespace eciton;

std::unique_ptr<runtime::Executor> make_executor(const deploy::ModuleConfig& config,
                                                 const runtime::ExecutorConfig& executor_config,
                                                 std::vector<bus::Participant*> participants) {
  if (config.clock == "lockstep") {
    return std::make_unique<runtime::LockstepExecutor>(executor_config, std::move(participants));
  }
  return std::make_unique<runtime::RealtimeExecutor>(executor_config, std::move(participants));
}

int run(int argc, char** argv) {
  const deploy::ProgramOptions options = deploy::parse_options(argc, argv, "Runs services of one module.",
                                                               {.names = true, .checkpoints = true, .faults = true});
  deploy::ModuleConfig config = value_or_throw(deploy::load_module_config(options.config_files, options.assignments));
  deploy::set_fault_directory(config, options.faults);
  config.radio.incarnation = config.docking.incarnation = deploy::incarnation_at(wall_now());
  const std::string process = options.names.size() == 1 ? options.names.front() : "services";
  start_log(config.name + "/" + process, options.log_level);

  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  // Samples come through the vendors' threads: late there is late everywhere.
  std::optional<runtime::RealtimeForNewThreads> vendors_too(std::in_place, config.realtime_priority);
  bus::Participant ring(config.module_participant(process));
  std::optional<bus::Participant> swarm;
  std::vector<bus::Participant*> participants{&ring};
  const bool has_radio = std::find(options.names.begin(), options.names.end(), "radio") != options.names.end();
  if (has_radio) {
    swarm.emplace(config.swarm_participant(process), &ring.waker());
    participants.push_back(&*swarm);
  }
  vendors_too.reset();
  std::vector<std::unique_ptr<runtime::Service>> services;
  for (const std::string& name : options.names) {
    services.push_back(deploy::make_service(name, config, ring, swarm ? &*swarm : nullptr));
  }
  const auto executor = make_executor(config,
                                      {.module_id = config.id,
                                       .process = process,
                                       .realtime_priority = config.realtime_priority,
                                       .checkpoints = options.checkpoints},
                                      participants);
  for (const auto& service : services) executor->add(*service);
  // The radio has a state that a restart does not lose; a process that flies as well is not ended for an address.
  std::optional<runtime::InterfaceWatch> swarm_interface;
  if (has_radio && options.names.size() == 1) swarm_interface.emplace(config.swarm_ring.network_interface, stop);
  const runtime::Watchdog watchdog([&] { return executor->find_idle(); });
  executor->run(stop);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return eciton::deploy::run_program("eciton-service", [&] { return run(argc, argv); });
}
