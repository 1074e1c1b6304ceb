// The handler reaches the flag through one pointer of the process.
#include "core/runtime/stop_signal.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <thread>

#include "core/base/contract.hpp"
#include "core/base/result.hpp"

namespace eciton::runtime {

namespace {

constexpr std::array stop_signals{SIGINT, SIGTERM};
std::atomic<StopFlag*> flag_of_process{nullptr};

void on_signal(int) {
  const int error_before = errno;
  if (StopFlag* flag = flag_of_process.load()) flag->request();
  errno = error_before;
}

}  // namespace

StopFlag::StopFlag() : fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (fd_ < 0) throw BadInput{{"no event descriptor can be made: the process's limit of open files is too low"}};
}

StopFlag::~StopFlag() { ::close(fd_); }

void StopFlag::request() noexcept {
  requested_.store(true, std::memory_order_release);
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(fd_, &one, sizeof one);
  requesting_.fetch_add(1);
  for (const auto& each : wakers_) {
    if (bus::Waker* waker = each.load()) waker->signal();
  }
  requesting_.fetch_sub(1);
}

void StopFlag::also_wake(bus::Waker& waker) const {
  for (auto& each : wakers_) {
    bus::Waker* none = nullptr;
    if (each.compare_exchange_strong(none, &waker)) return;
  }
  ECITON_EXPECT(false, "at most eight sleepers to one stop flag");
}

void StopFlag::no_longer_wake(bus::Waker& waker) const noexcept {
  for (auto& each : wakers_) {
    bus::Waker* this_one = &waker;
    if (each.compare_exchange_strong(this_one, nullptr)) break;
  }
  // A request under way may have seen it before; without a lock, since a signal handler may be the one that requests.
  while (requesting_.load() != 0) std::this_thread::yield();
}

StopOnSignals::StopOnSignals(StopFlag& flag) {
  ECITON_EXPECT(flag_of_process.load() == nullptr, "one StopOnSignals per process");
  flag_of_process.store(&flag);
  struct sigaction action {};
  action.sa_handler = &on_signal;
  // Once each: whoever insists need not reach for SIGKILL.
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (std::size_t k = 0; k < stop_signals.size(); ++k) ::sigaction(stop_signals[k], &action, &before_[k]);
}

StopOnSignals::~StopOnSignals() {
  for (std::size_t k = 0; k < stop_signals.size(); ++k) ::sigaction(stop_signals[k], &before_[k], nullptr);
  flag_of_process.store(nullptr);
}

}  // namespace eciton::runtime
