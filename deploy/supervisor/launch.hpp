// One thing that is brought up and down as a whole: a module, or a simulated world. It holds its runtime
// directory and what it claims of the host, and supervises its processes.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "deploy/supervisor/host_claim.hpp"
#include "deploy/supervisor/runtime_directory.hpp"
#include "deploy/supervisor/supervisor.hpp"

namespace eciton::deploy {

struct PlannedProcess {
  std::string name;    // "control"; "services" when composed
  std::string vendor;  // empty: it uses none
  ChildSpec child;
  bool has_checkpoints = false;  // in the launch's directory: `--checkpoints` is added to its arguments
  bool records_faults = false;   // in its subdirectory `faults`: `--faults` is added
};

struct LaunchPlan {
  std::string name;             // "m3", "world": of its runtime directory
  std::uint32_t module_id = 0;  // 0: not a module
  std::uint32_t domain = 0;     // of its module ring
  std::string network_interface;
  std::filesystem::path network_namespace{};  // of that interface; empty: ours
  std::vector<std::string> claims;            // of the host, as "module id 3"
  std::vector<PlannedProcess> processes;
  std::filesystem::path faults{};  // directory of its fault records; empty: below its runtime directory
};

class Launch {
 public:
  /// Claims everything and starts nothing; an Error names what is taken, and by whom.
  static Result<std::unique_ptr<Launch>> claim(const LaunchPlan& plan);
  /// Stops what runs and leaves nothing behind.
  ~Launch();
  Launch(const Launch&) = delete;
  Launch& operator=(const Launch&) = delete;

  /// Starts all its processes; an Error when one cannot be executed.
  Status start();
  /// As Supervisor::check; also keeps the state file, which `eciton status` reads, up to date.
  void check(const std::function<void(const ChildReport&)>& on_end);

  const LaunchPlan& plan() const { return plan_; }
  /// To write configs into, before the start.
  const std::filesystem::path& directory() const { return directory_.path(); }
  Supervisor& supervisor() { return supervisor_; }
  /// `eciton down` asked for its end.
  bool stop_requested() const { return directory_.stop_requested(); }
  /// Copies the logs to a directory that outlives it, each as <name>-<process>.log.
  Status keep_logs(const std::filesystem::path& directory) const;

 private:
  Launch(LaunchPlan plan, RuntimeDirectory directory, std::vector<HostClaim> claims);
  void write_state();

  LaunchPlan plan_;
  std::vector<HostClaim> claims_;
  RuntimeDirectory directory_;
  Supervisor supervisor_;
  std::string written_state_;
};

/// The directory of the running program, where the others are too.
std::filesystem::path program_directory();

}  // namespace eciton::deploy
