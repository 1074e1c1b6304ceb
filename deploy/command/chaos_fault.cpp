// Signals to processes, settings of the radio.
#include "deploy/command/chaos_fault.hpp"

#include <csignal>

#include "deploy/net/net.hpp"

namespace eciton::deploy {

const char* name_of(FaultKind kind) {
  constexpr std::array names{"kill", "hang", "partition", "loss"};
  return names[static_cast<std::size_t>(kind)];
}

const char* name_of(FlightStage stage) {
  constexpr std::array names{"separated", "approach", "assembled"};
  return names[static_cast<std::size_t>(stage)];
}

std::string ChaosCell::text() const {
  return std::string(name_of(kind)) + " m" + std::to_string(module_id) + (process.empty() ? "" : "/" + process) +
         ", " + name_of(stage);
}

Duration ChaosCell::lasts() const {
  using namespace std::chrono_literals;
  switch (kind) {
    case FaultKind::kill:
      return 0s;
    case FaultKind::hang:
      return 800ms;
    case FaultKind::partition:
      return 3s;
    case FaultKind::loss:
      return 5s;
  }
  return 0s;
}

pid_t FaultInjector::pid_of(const ChaosCell& cell) const {
  for (const auto& launch : launches_) {
    if (launch->plan().module_id != cell.module_id) continue;
    for (const ChildReport& report : launch->supervisor().reports()) {
      if (report.name == cell.process && report.state == ChildState::running) return report.pid;
    }
  }
  return 0;
}

Status FaultInjector::set_link(std::uint32_t module_id, const std::string& word) {
  const std::string host = net::host_name(module_id);
  if (const Status out = net::set_links(net_, host, "", {word}); !out) return out;
  return net::set_links(net_, "", host, {word});
}

Status FaultInjector::begin(const ChaosCell& cell) {
  if (cell.kind == FaultKind::partition) return set_link(cell.module_id, "cut=on");
  if (cell.kind == FaultKind::loss) return set_link(cell.module_id, "loss=20%");
  struck_ = pid_of(cell);
  if (struck_ == 0) return Error{cell.text() + ": the process does not run"};
  ::kill(struck_, cell.kind == FaultKind::kill ? SIGKILL : SIGSTOP);
  return ok();
}

Status FaultInjector::end(const ChaosCell& cell) {
  if (cell.kind == FaultKind::partition) return set_link(cell.module_id, "cut=off");
  if (cell.kind == FaultKind::loss) return set_link(cell.module_id, "loss=0%");
  // If a supervisor has not killed it meanwhile.
  if (cell.kind == FaultKind::hang && pid_of(cell) == struck_) ::kill(struck_, SIGCONT);
  return ok();
}

}  // namespace eciton::deploy
