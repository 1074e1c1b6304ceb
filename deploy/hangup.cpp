// The handler reaches the flag through one pointer of the process.
#include "deploy/hangup.hpp"

#include <atomic>
#include <cerrno>

#include "core/base/contract.hpp"

namespace eciton::deploy {
namespace {

using Action = struct sigaction;

std::atomic<runtime::StopFlag*> flag_of_process{nullptr};

void on_hangup(int) {
  const int error_before = errno;
  if (runtime::StopFlag* flag = flag_of_process.load()) flag->request();
  errno = error_before;
}

}  // namespace

IgnoredSignals::IgnoredSignals(std::initializer_list<int> signals) {
  struct sigaction ignored {};
  ignored.sa_handler = SIG_IGN;
  for (const int signal : signals) {
    before_.emplace_back(signal, Action{});
    ::sigaction(signal, &ignored, &before_.back().second);
  }
}

IgnoredSignals::~IgnoredSignals() {
  for (const auto& [signal, action] : before_) ::sigaction(signal, &action, nullptr);
}

StopOnHangup::StopOnHangup(runtime::StopFlag& flag) {
  ECITON_EXPECT(flag_of_process.load() == nullptr, "one StopOnHangup per process");
  flag_of_process.store(&flag);
  ::sigaction(SIGHUP, nullptr, &before_);
  if (before_.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = &on_hangup;
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGHUP, &action, nullptr);
}

StopOnHangup::~StopOnHangup() {
  ::sigaction(SIGHUP, &before_, nullptr);
  flag_of_process.store(nullptr);
}

}  // namespace eciton::deploy
