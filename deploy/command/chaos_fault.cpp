// Signals to processes, settings of the radio.
#include "deploy/command/chaos_fault.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "deploy/net/net.hpp"
#include "deploy/net/tap.hpp"

namespace eciton::deploy {

namespace {

constexpr const char* filler = "filler";  // of the disk

}  // namespace

const char* name_of(FaultKind kind) {
  constexpr std::array names{"kill", "hang", "partition", "loss", "address", "full_disk"};
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
    case FaultKind::address:
      return 0s;
    case FaultKind::hang:
      return 800ms;
    case FaultKind::partition:
    case FaultKind::full_disk:
      return 3s;
    case FaultKind::loss:
      return 5s;
  }
  return 0s;
}

pid_t FaultInjector::pid_of(const ChaosCell& cell) const {
  const std::string name = cell.replaced();
  for (const auto& launch : launches_) {
    if (launch->plan().module_id != cell.module_id) continue;
    for (const ChildReport& report : launch->supervisor().reports()) {
      if (report.name == name && report.state == ChildState::running) return report.pid;
    }
  }
  return 0;
}

Status FaultInjector::set_link(std::uint32_t module_id, const std::string& word) {
  const std::string host = net::host_name(module_id);
  if (const Status out = net::set_links(net_.name, host, "", {word}); !out) return out;
  return net::set_links(net_.name, "", host, {word});
}

/// To its other address, and the next time back.
Status FaultInjector::move(std::uint32_t module_id) {
  const bool back = moved_.erase(module_id) > 0;
  if (!back) moved_.insert(module_id);
  return net::set_address(net_.name, module_id, net_.modules,
                          back ? net::host_address(module_id) : net::moved_address(module_id));
}

/// To the last byte.
Status FaultInjector::fill_disk() {
  const int fd = ::open((disk_ / filler).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (fd < 0) return Error{"disk " + disk_.string() + " cannot be filled: " + std::strerror(errno)};
  const std::vector<char> block(1 << 16);
  std::size_t size = block.size();
  while (size > 0) {
    const ssize_t written = ::write(fd, block.data(), size);
    if (written < 0) size /= 2;  // there is less room, or none
  }
  ::close(fd);
  return ok();
}

Status FaultInjector::begin(const ChaosCell& cell) {
  if (cell.kind == FaultKind::partition) return set_link(cell.module_id, "cut=on");
  if (cell.kind == FaultKind::loss) return set_link(cell.module_id, "loss=20%");
  if (cell.kind == FaultKind::address) {
    struck_ = pid_of(cell);
    return move(cell.module_id);
  }
  if (cell.kind == FaultKind::full_disk) return fill_disk();
  struck_ = pid_of(cell);
  if (struck_ == 0) return Error{cell.text() + ": the process does not run"};
  ::kill(struck_, cell.kind == FaultKind::kill ? SIGKILL : SIGSTOP);
  return ok();
}

Status FaultInjector::end(const ChaosCell& cell) {
  if (cell.kind == FaultKind::partition) return set_link(cell.module_id, "cut=off");
  if (cell.kind == FaultKind::loss) return set_link(cell.module_id, "loss=0%");
  if (cell.kind == FaultKind::full_disk) std::filesystem::remove(disk_ / filler);
  // If a supervisor has not killed it meanwhile.
  if (cell.kind == FaultKind::hang && pid_of(cell) == struck_) ::kill(struck_, SIGCONT);
  return ok();
}

}  // namespace eciton::deploy
