// An event file descriptor behind an atomic flag, so that only the first of many signals costs a call.
#include "core/bus/waker.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

#include "core/base/result.hpp"

namespace eciton::bus {

Waker::Waker() : fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (fd_ < 0) throw BadInput{{"no event descriptor can be made: the process's limit of open files is too low"}};
}
Waker::~Waker() { ::close(fd_); }

void Waker::signal() noexcept {
  if (signalled_.exchange(true, std::memory_order_acq_rel)) return;
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(fd_, &one, sizeof one);
}

void Waker::clear() noexcept {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto got = ::read(fd_, &count, sizeof count);
  // After the read: a signal in between is seen by the look for work that follows clear().
  signalled_.store(false, std::memory_order_release);
}

bool Waker::wait(Duration timeout) noexcept {
  pollfd poll_on{fd_, POLLIN, 0};
  const auto ns = timeout.count() < 0 ? 0 : timeout.count();
  const timespec ts{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
  if (::ppoll(&poll_on, 1, &ts, nullptr) <= 0) return false;
  clear();
  return true;
}

}  // namespace eciton::bus
