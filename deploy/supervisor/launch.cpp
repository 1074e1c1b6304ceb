// Claims, starts, and writes down what runs.
#include "deploy/supervisor/launch.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "deploy/supervisor/running_modules.hpp"

namespace eciton::deploy {

namespace fs = std::filesystem;

namespace {

std::string end_text(const ChildReport& report) {
  if (!report.last_end) return {};
  return report.hung ? "it hung" : report.last_end->text();
}

}  // namespace

fs::path program_directory() {
  std::error_code failed;
  return fs::read_symlink("/proc/self/exe", failed).parent_path();
}

Result<std::unique_ptr<Launch>> Launch::claim(const LaunchPlan& plan) {
  std::vector<HostClaim> claims;
  for (const std::string& what : plan.claims) {
    Result<HostClaim> claim = HostClaim::take(what);
    if (!claim) return Error{plan.name + ": " + claim.error().message};
    claims.push_back(std::move(claim).value());
  }
  Result<RuntimeDirectory> directory = RuntimeDirectory::claim(plan.name);
  if (!directory) return directory.error();
  return std::unique_ptr<Launch>(new Launch(plan, std::move(directory).value(), std::move(claims)));
}

Launch::Launch(LaunchPlan plan, RuntimeDirectory directory, std::vector<HostClaim> claims)
    : plan_(std::move(plan)),
      claims_(std::move(claims)),
      directory_(std::move(directory)),
      supervisor_(SupervisorConfig{.log_directory = directory_.path()}) {
  for (PlannedProcess& process : plan_.processes) {
    std::vector<std::string>& arguments = process.child.arguments;
    const fs::path& own = directory_.path();
    if (process.has_checkpoints) arguments.insert(arguments.end(), {"--checkpoints", own.string()});
    if (process.records_faults) arguments.insert(arguments.end(), {"--faults", (own / faults_name).string()});
  }
}

Launch::~Launch() { supervisor_.stop_all(); }

Status Launch::start() {
  for (const PlannedProcess& process : plan_.processes) {
    if (const Status status = supervisor_.start(process.child); !status) {
      supervisor_.stop_all();
      return Error{plan_.name + ": " + status.error().message};
    }
  }
  write_state();
  return ok();
}

void Launch::check(const std::function<void(const ChildReport&)>& on_end) {
  supervisor_.check(on_end);
  write_state();
}

void Launch::write_state() {
  RunningModule state{.name = plan_.name,
                      .holder = ::getpid(),
                      .module_id = plan_.module_id,
                      .domain = plan_.domain,
                      .network_interface = plan_.network_interface,
                      .network_namespace = plan_.network_namespace,
                      .processes = {},
                      .faults = plan_.faults.empty() ? directory_.path() / faults_name : plan_.faults};
  const std::vector<ChildReport> reports = supervisor_.reports();
  for (std::size_t k = 0; k < reports.size(); ++k) {
    state.processes.push_back({.name = plan_.processes[k].name,
                               .vendor = plan_.processes[k].vendor,
                               .pid = reports[k].state == ChildState::running ? reports[k].pid : 0,
                               .restarts = reports[k].restarts,
                               .hangs = reports[k].hangs,
                               .last_end = end_text(reports[k])});
  }
  const std::string text = to_text(state);
  if (text == written_state_) return;
  // Renamed into place: nobody reads half of it.
  const fs::path file = directory_.path() / state_file_name, draft = directory_.path() / "state.draft";
  std::ofstream(draft) << text;
  std::error_code failed;
  fs::rename(draft, file, failed);
  if (!failed) written_state_ = text;
}

Status Launch::keep_logs(const fs::path& directory) const {
  std::error_code failed;
  fs::create_directories(directory, failed);
  for (const PlannedProcess& process : plan_.processes) {
    const fs::path from = supervisor_.log_file(process.child.name);
    if (!fs::exists(from)) continue;
    const fs::path to = directory / (plan_.name + "-" + process.name + ".log");
    fs::copy_file(from, to, fs::copy_options::overwrite_existing, failed);
    if (failed) return Error{"log " + to.string() + " cannot be written: " + failed.message()};
  }
  return ok();
}

}  // namespace eciton::deploy
