// The schedule starts anew with every discovery, so a fleet that starts together costs few announcements.
#include "core/bus/vendors/reannouncer.hpp"

#include <array>
#include <utility>

namespace eciton::bus::vendors {
namespace {

using std::chrono::milliseconds;
// The last for a machine so busy that the new participant's threads wait their turn.
constexpr std::array<milliseconds, 2> kAfter = {milliseconds(25), milliseconds(200)};

}  // namespace

Reannouncer::Reannouncer(std::function<void()> announce)
    : announce_(std::move(announce)), thread_([this] { run(); }) {}

Reannouncer::~Reannouncer() { stop(); }

void Reannouncer::discovered() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    discovered_at_ = std::chrono::steady_clock::now();
    announced_ = 0;
    pending_ = true;
  }
  changed_.notify_all();
}

void Reannouncer::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Reannouncer::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_) {
    if (!pending_) {
      changed_.wait(lock);
    } else if (const auto due = discovered_at_ + kAfter[announced_]; std::chrono::steady_clock::now() < due) {
      changed_.wait_until(lock, due);
    } else {
      pending_ = ++announced_ < kAfter.size();
      lock.unlock();
      announce_();
      lock.lock();
    }
  }
}

}  // namespace eciton::bus::vendors
