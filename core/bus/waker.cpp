// A futex with three states, so that only the first of many signals to a sleeping thread costs a call; and an event
// descriptor beside it for whoever polls.
#include "core/bus/waker.hpp"

#include <linux/futex.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

#include "core/base/result.hpp"
#include "core/base/wall_clock.hpp"

namespace eciton::bus {
namespace {

static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t), "the kernel looks at the word itself");

/// Sleeps while the word is `value`, at most until an instant of the monotonic clock. False: it came.
bool futex_wait(std::atomic<std::uint32_t>& word, std::uint32_t value, const timespec& until) {
  return ::syscall(SYS_futex, &word, FUTEX_WAIT_BITSET_PRIVATE, value, &until, nullptr, FUTEX_BITSET_MATCH_ANY) ==
             0 ||
         errno == EAGAIN || errno == EINTR;
}

void futex_wake(std::atomic<std::uint32_t>& word) {
  ::syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

}  // namespace

Waker::Waker() : fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (fd_ < 0) throw BadInput{{"no event descriptor can be made: the process's limit of open files is too low"}};
}
Waker::~Waker() { ::close(fd_); }

void Waker::signal() noexcept {
  const int error_before = errno;  // of whoever a signal handler interrupted
  const std::uint32_t before = state_.exchange(signalled);
  if (before == sleeping) futex_wake(state_);
  if (before != signalled && polled_.load()) {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(fd_, &one, sizeof one);
  }
  errno = error_before;
}

bool Waker::wait_until(Duration monotonic) noexcept {
  const timespec until = to_timespec(monotonic);
  std::uint32_t expected = idle;
  if (state_.compare_exchange_strong(expected, sleeping)) {
    while (state_.load() == sleeping && futex_wait(state_, sleeping, until)) {
    }
  }
  drain();
  return state_.exchange(idle) == signalled;
}

bool Waker::wait(Duration timeout) noexcept { return wait_until(monotonic_now() + timeout); }

int Waker::file_descriptor() {
  polled_.store(true);
  // A signal before this wrote nothing.
  if (state_.exchange(idle) == signalled) signal();
  return fd_;
}

void Waker::drain() noexcept {
  if (!polled_.load(std::memory_order_relaxed)) return;
  std::uint64_t count = 0;
  [[maybe_unused]] const auto got = ::read(fd_, &count, sizeof count);
}

void Waker::clear() noexcept {
  drain();
  // After the read: a signal in between is seen by the look for work that follows clear().
  state_.store(idle);
}

}  // namespace eciton::bus
