// The thread that looks and sends.
#include "core/runtime/watchdog.hpp"

#include <systemd/sd-daemon.h>

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <optional>

#include "core/base/log.hpp"

namespace eciton::runtime {
namespace {

constexpr Duration look_while_starting = std::chrono::milliseconds(10);
constexpr Duration unwatched_look = std::chrono::milliseconds(500);
constexpr int looks_per_limit = 4;  // systemd asks for at least two
constexpr int idle_looks_told = 2;
constexpr Duration end_patience = std::chrono::seconds(1);

/// Between two looks; nothing: nobody asks for signs of life.
std::optional<Duration> watched_look() {
  std::uint64_t limit_us = 0;
  if (::sd_watchdog_enabled(0, &limit_us) <= 0) return std::nullopt;
  return std::max<Duration>(std::chrono::microseconds(limit_us / looks_per_limit), std::chrono::milliseconds(1));
}

}  // namespace

struct Watchdog::Shared {
  FindIdle find_idle;
  std::mutex mutex;
  std::condition_variable changed;
  bool ending = false;
  bool ended = false;

  void run();
  /// Unlocked meanwhile: a supervisor that does not read its socket holds up the sender.
  static void send(std::unique_lock<std::mutex>& lock, const char* what) {
    lock.unlock();
    ::sd_notify(0, what);
    lock.lock();
  }
};

void Watchdog::Shared::run() {
  const std::optional<Duration> watched = watched_look();
  bool ready = false;
  int idle_looks = 0;
  std::unique_lock lock(mutex);
  const auto told_to_end = [this] { return ending; };
  while (!changed.wait_for(lock, ready ? watched.value_or(unwatched_look) : look_while_starting, told_to_end)) {
    if (ready && !watched) continue;
    const std::string_view idle = find_idle();
    if (idle.empty()) {
      idle_looks = 0;
      send(lock, ready ? "WATCHDOG=1" : "READY=1\nWATCHDOG=1");
      ready = true;
    } else if (ready && ++idle_looks == idle_looks_told) {
      spdlog::error("{} has not stepped for {:.2f} s", idle, to_s(idle_looks_told * *watched));
    }
  }
  send(lock, "STOPPING=1");
  ended = true;
  changed.notify_all();
}

Watchdog::Watchdog(FindIdle find_idle) {
  if (const char* socket = std::getenv("NOTIFY_SOCKET"); socket == nullptr || *socket == '\0') return;
  shared_ = std::make_shared<Shared>();
  shared_->find_idle = std::move(find_idle);
  thread_ = std::thread([shared = shared_] { shared->run(); });
}

Watchdog::~Watchdog() {
  if (!thread_.joinable()) return;
  std::unique_lock lock(shared_->mutex);
  shared_->ending = true;
  shared_->changed.notify_all();
  const bool ended = shared_->changed.wait_for(lock, end_patience, [this] { return shared_->ended; });
  lock.unlock();
  // Held up in a call of the system, it touches only what it shares.
  ended ? thread_.join() : thread_.detach();
}

}  // namespace eciton::runtime
