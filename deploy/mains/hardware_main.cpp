// eciton-hardware --config MODULE.yaml: the hardware host of one module. It owns the devices, puts them on the
// module's ring, paces the ring in lockstep, and has a safe output of its own.
#include <optional>

#include "core/base/log.hpp"
#include "core/base/wall_clock.hpp"
#include "core/runtime/checkpoint.hpp"
#include "core/runtime/lockstep_master.hpp"
#include "core/runtime/realtime_thread.hpp"
#include "core/runtime/service_group.hpp"
#include "core/runtime/watchdog.hpp"
#include "deploy/module.hpp"
#include "deploy/program.hpp"
#include "hal/host/resumption.hpp"
#include "hal/sim/make_devices.hpp"
#include "hal/sim/socket_link.hpp"

namespace {

using namespace eciton;

constexpr Duration connect_timeout = std::chrono::seconds(30);
constexpr Duration ack_timeout = std::chrono::seconds(10);
constexpr Duration command_wait_lockstep = std::chrono::milliseconds(50);
constexpr Duration command_wait_wall = std::chrono::microseconds(1500);  // of the 2 ms to the next readings

/// One module's hardware behind the world's socket: sense, wait for control, act, tick by tick.
class SimulatedHost {
 public:
  SimulatedHost(const deploy::ModuleConfig& config, const std::filesystem::path& checkpoints,
                const runtime::StopFlag& stop)
      : stop_(stop),
        airframe_(deploy::make_airframe(config)),
        link_(value_or_throw(hal::sim::SocketLink::connect(config.hal.socket, config.id, connect_timeout))),
        lockstep_(link_->pace() == hal::sim::Pace::lockstep),
        devices_(hal::sim::make_devices(link_->board(), airframe_, config.hal.battery_compensation)),
        resumption_(resume(checkpoints)),
        ring_(config.module_participant("hardware")),
        group_({.module_id = config.id, .process = "hardware", .checkpoints = checkpoints}, {&ring_},
               lockstep_ ? runtime::ServiceGroup::Pacing::lockstep : runtime::ServiceGroup::Pacing::wall_clock) {
    if (lockstep_) ring_.set_all_wake(false);
    sense_.emplace(ring_, hal::SenseConfig{.module_id = config.id}, devices_);
    act_.emplace(ring_, hal::ActConfig{.module_id = config.id, .recorder = config.recorder}, airframe_, devices_);
    sense_entry_ = &group_.add(*sense_);
    act_entry_ = &group_.add(*act_);
    commands_ = act_entry_->schedule.trigger;
    commands_->set_wakes(true);
    if (lockstep_) master_.emplace(ring_, config.service_processes(), stop);
    sleeper_.emplace(ring_.waker(), stop);
  }

  void run() {
    if (resumption_) act_->go_on(resumption_->end());
    group_.start(lockstep_ ? link_->board().sensors().stamp.time_since_epoch() : monotonic_now());
    while (!stop_.requested()) {
      turns_.turn();
      const hal::Io io = link_->wait_sensors(std::chrono::milliseconds(10));
      if (io == hal::Io::error) {
        spdlog::info("the world has gone: {}", std::string(link_->end_reason()));
        break;
      }
      if (io != hal::Io::ok) continue;
      tick();
    }
    group_.say_farewell(lockstep_ ? link_->board().sensors().stamp : wall_now());
  }

  /// For a watchdog. A world that sends nothing does not make the host idle.
  std::string_view find_idle() noexcept {
    if (!turns_.has_turned()) return "hardware";
    turns_.note();
    return {};
  }

 private:
  /// Powers the devices; what flew a moment ago flies on before there is a ring.
  std::unique_ptr<hal::Resumption> resume(const std::filesystem::path& checkpoints) {
    // Joints hold where they are, which the first readings tell; in lockstep they come with the first tick.
    if (!lockstep_) link_->wait_sensors(std::chrono::milliseconds(100));
    deploy::bring_up(devices_);
    if (lockstep_ || checkpoints.empty()) return nullptr;
    const auto wait = [this] { return link_->wait_sensors(std::chrono::milliseconds(10)) == hal::Io::ok; };
    return hal::Resumption::begin(runtime::checkpoint_file(checkpoints, hal::ActService::service_name), airframe_,
                                  devices_, {.wait_sensors = wait, .act = [this] { link_->act(); }}, wall_now());
  }

  void tick() {
    const TimePoint stamp = link_->board().sensors().stamp;
    const Duration pace = lockstep_ ? stamp.time_since_epoch() : monotonic_now();
    const TimePoint now = lockstep_ ? stamp : wall_now();
    group_.step(*sense_entry_, pace, now);
    if (lockstep_) {
      master_->publish(link_->tick(), stamp, sense_->imu_sampled());
      if (const Status status = master_->wait_for_acks(ack_timeout); !status) {
        if (stop_.requested()) return;
        throw std::runtime_error(status.error().message);
      }
    }
    await_command(now);
    group_.step(*act_entry_, lockstep_ ? pace : monotonic_now(), lockstep_ ? now : wall_now());
    link_->act();
    group_.beat_if_due(pace, now);
  }

  /// What control makes of these readings still goes out with this tick.
  void await_command(TimePoint now) {
    if (!sense_->imu_sampled()) return;
    const Duration until = monotonic_now() + (lockstep_ ? command_wait_lockstep : command_wait_wall);
    while (!stop_.requested()) {
      commands_->fetch();
      // By the stamp, on the wall clock too: a command that came late for the last tick, taken for this one's, would
      // leave this one's to the next, and so on for ever.
      if (commands_->newest_stamp() >= now) return;
      if (monotonic_now() >= until) return;
      sleeper_->until(until);
    }
  }

  const runtime::StopFlag& stop_;
  robot::Airframe airframe_;
  std::unique_ptr<hal::sim::SocketLink> link_;
  bool lockstep_;
  hal::Devices devices_;
  std::unique_ptr<hal::Resumption> resumption_;
  bus::Participant ring_;
  runtime::ServiceGroup group_;
  std::optional<hal::SenseService> sense_;
  std::optional<hal::ActService> act_;
  runtime::ServiceGroup::Entry* sense_entry_ = nullptr;
  runtime::ServiceGroup::Entry* act_entry_ = nullptr;
  bus::ReaderCore* commands_ = nullptr;
  std::optional<runtime::LockstepMaster> master_;
  std::optional<runtime::Sleeper> sleeper_;
  runtime::LoopProgress turns_;
};

int run(int argc, char** argv) {
  const deploy::ProgramOptions options =
      deploy::parse_options(argc, argv, "The hardware host of one module.", {.checkpoints = true, .faults = true});
  deploy::ModuleConfig config = value_or_throw(deploy::load_module_config(options.config_files, options.assignments));
  deploy::set_fault_directory(config, options.faults);
  if (config.hal.socket.empty()) throw BadInput{{"hal.socket is missing; expected the path of the world's socket"}};
  start_log(config.name + "/hardware", options.log_level);
  runtime::StopFlag stop;
  const runtime::StopOnSignals on_signals(stop);
  std::optional<SimulatedHost> host;
  {
    // Samples come through the vendor's threads: late there is late everywhere.
    const runtime::RealtimeForNewThreads vendor_too(config.realtime_priority);
    host.emplace(config, options.checkpoints, stop);
  }
  const runtime::Watchdog watchdog([&] { return host->find_idle(); });
  if (config.realtime_priority > 0) {
    if (const auto missing = runtime::make_realtime(config.realtime_priority)) spdlog::warn("{}", *missing);
  }
  host->run();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return eciton::deploy::run_program("eciton-hardware", [&] { return run(argc, argv); });
}
