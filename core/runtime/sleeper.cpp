// A timer, the waker's and the stop flag's descriptors in one poll.
#include "core/runtime/sleeper.hpp"

#include <poll.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>

#include "core/base/result.hpp"

namespace eciton::runtime {

namespace {

timespec to_timespec(Duration d) {
  // A zero time would disarm a timer.
  const auto ns = std::max<Duration::rep>(d.count(), 1);
  return {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
}

}  // namespace

Sleeper::Sleeper(bus::Waker& waker, const StopFlag& stop)
    : waker_(waker), stop_(stop), timer_fd_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
  if (timer_fd_ < 0) throw BadInput{{"no timer can be made: the process's limit of open files is too low"}};
}

Sleeper::~Sleeper() { ::close(timer_fd_); }

void Sleeper::until(Duration monotonic) noexcept {
  const itimerspec timer{{}, to_timespec(monotonic)};
  ::timerfd_settime(timer_fd_, TFD_TIMER_ABSTIME, &timer, nullptr);
  std::array<pollfd, 3> wait{
      {{timer_fd_, POLLIN, 0}, {waker_.file_descriptor(), POLLIN, 0}, {stop_.file_descriptor(), POLLIN, 0}}};
  if (::ppoll(wait.data(), wait.size(), nullptr, nullptr) > 0 && wait[1].revents != 0) waker_.clear();
}

void Sleeper::until_undisturbed(Duration monotonic) noexcept {
  const timespec at = to_timespec(monotonic);
  if (!stop_.requested()) ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

bool Sleeper::for_at_most(Duration timeout) noexcept {
  const timespec at_most = to_timespec(timeout);
  std::array<pollfd, 2> wait{{{waker_.file_descriptor(), POLLIN, 0}, {stop_.file_descriptor(), POLLIN, 0}}};
  if (::ppoll(wait.data(), wait.size(), &at_most, nullptr) <= 0 || wait[0].revents == 0) return false;
  waker_.clear();
  return true;
}

}  // namespace eciton::runtime
