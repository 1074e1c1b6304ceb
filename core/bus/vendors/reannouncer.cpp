// The schedule starts anew with every discovery, so a fleet that starts together costs few announcements.
#include "core/bus/vendors/reannouncer.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace eciton::bus::vendors {
namespace {

using std::chrono::milliseconds;
// The second for a machine so busy that the new participant's threads wait their turn.
constexpr std::array kAfter = {milliseconds(25), milliseconds(200), milliseconds(1000), milliseconds(3000)};
constexpr std::size_t kAfterDiscovery = 2;

}  // namespace

Reannouncer::Reannouncer(std::function<void()> announce)
    : announce_(std::move(announce)), thread_([this] { run(); }) {}

Reannouncer::~Reannouncer() { stop(); }

void Reannouncer::started() { repeat(kAfter.size()); }
void Reannouncer::discovered() { repeat(kAfterDiscovery); }

void Reannouncer::repeat(std::size_t times) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    since_ = std::chrono::steady_clock::now();
    times_ = std::max(times, announced_ < times_ ? times_ : 0);
    announced_ = 0;
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
    if (announced_ >= times_) {
      changed_.wait(lock);
    } else if (const auto due = since_ + kAfter[announced_]; std::chrono::steady_clock::now() < due) {
      changed_.wait_until(lock, due);
    } else {
      ++announced_;
      lock.unlock();
      announce_();
      lock.lock();
    }
  }
}

}  // namespace eciton::bus::vendors
