// The config of one module: one YAML file. What each process of the module needs is in here; a process
// reads the whole file, so that a mistake anywhere is found by every one of them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/base/config.hpp"
#include "core/bus/participant.hpp"
#include "core/runtime/flight_recorder.hpp"
#include "services/control/control_service.hpp"
#include "services/docking/docking_service.hpp"
#include "services/estimation/estimation_service.hpp"
#include "services/joints/joints_service.hpp"
#include "services/radio/radio_service.hpp"

namespace eciton::deploy {

/// The services of a module in the order of the data flow; the hardware host is a process beside them.
inline constexpr std::array<std::string_view, 5> service_names{"estimation", "control", "docking", "joints", "radio"};

struct RingConfig {
  std::uint32_t domain = 0;
  std::string network_interface = "lo";
  std::vector<std::string> peers;  // none: multicast

  template <class V>
  void visit_fields(V& v) {
    v("domain", domain, in_range(0, 231));
    v("interface", network_interface);
    v("peers", peers);
  }
};

struct HardwareConfig {
  std::string backend = "sim";
  std::string socket;                // sim: the world's
  bool battery_compensation = true;  // of the thrust; false: an experiment's control

  template <class V>
  void visit_fields(V& v) {
    v("backend", backend, one_of({"sim"}));
    v("socket", socket);
    v("battery_compensation", battery_compensation);
  }
};

struct ModuleConfig {
  std::uint32_t id = 0;
  std::string name;  // empty: "m<id>"
  std::string airframe = "legion";
  std::string layout = "services";             // one process each; composed: all in one
  std::string clock = "wall";                  // or lockstep, paced by the world
  std::string dds = "cyclonedds";              // vendor of every process ...
  std::map<std::string, std::string> vendors;  // ... but of these: process name -> vendor
  RingConfig module_ring;                      // domain 0: 10 + id
  RingConfig swarm_ring{1, "lo", {}};
  double lease_s = 3;
  double watchdog_s = 0.4;  // a process that has not stepped for so long hangs, and is started again; 0: it is left
  double hardware_watchdog_s = 0.08;  // the hardware host: after 50 ms without it the board stops the rotors
  int realtime_priority = 0;          // SCHED_FIFO; 0: leave it
  runtime::RecorderConfig recorder;   // without a directory: that of the supervisor, if there is one
  HardwareConfig hal;
  estimation::EstimationConfig estimation;
  control::ControlConfig control;
  docking::DockingServiceConfig docking;
  joints::JointsConfig joints;
  radio::RadioConfig radio;

  template <class V>
  void visit_fields(V& v) {
    v("id", id, in_range(1, 90));
    v("name", name);
    v("airframe", airframe, one_of({"legion", "legion-lidar"}));
    v("layout", layout, one_of({"services", "composed"}));
    v("clock", clock, one_of({"wall", "lockstep"}));
    v("dds", dds);
    v("vendors", vendors);
    v("module_ring", module_ring);
    v("swarm_ring", swarm_ring);
    v("lease_s", lease_s, in_range(0.5, 60));
    v("watchdog_s", watchdog_s, in_range(0, 60));
    v("hardware_watchdog_s", hardware_watchdog_s, in_range(0, 60));
    v("realtime_priority", realtime_priority, in_range(0, 90));
    v("recorder", recorder);
    v("hal", hal);
    v("estimation", estimation);
    v("control", control);
    v("docking", docking);
    v("joints", joints);
    v("radio", radio);
  }

  /// Names of the processes that run a module's services: the five, or "services" when composed.
  std::vector<std::string> service_processes() const;
  /// The participants' configs of one process; ECITON_DDS beats the file.
  bus::ParticipantConfig module_participant(const std::string& process) const;
  bus::ParticipantConfig swarm_participant(const std::string& process) const;
};

/// The domain of a module's own ring unless its config names another.
constexpr std::uint32_t module_ring_domain(std::uint32_t module_id) { return 10 + module_id; }

/// Tells every part of the config whose it is, from `id` and `name`.
void set_identity(ModuleConfig& config);

/// Where its fault records go, unless its config says so itself; empty: nowhere.
void set_fault_directory(ModuleConfig& config, const std::string& directory);

/// Layers files and --set assignments, checks them and fills in what follows from the id.
Result<ModuleConfig> load_module_config(const std::vector<std::string>& files,
                                        const std::vector<std::string>& assignments);

}  // namespace eciton::deploy
