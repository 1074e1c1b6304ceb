// The pacing of a served world: lockstep and wall clock.
#include "hal/sim/world_server.hpp"

#include <time.h>
#include <unistd.h>

#include <algorithm>

#include "core/base/wall_clock.hpp"

namespace eciton::hal::sim {
namespace {

constexpr Duration stop_check = 100ms;  // how long a wait may hide a call of stop
/// Behind by more than this, the wall-clock world jumps instead of catching up.
constexpr Duration catch_up_max = 1s;

void sleep_until(Duration monotonic) {
  const timespec t{.tv_sec = monotonic / 1s, .tv_nsec = (monotonic % 1s).count()};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) != 0) {
  }
}

}  // namespace

WorldServer::WorldServer(World& world, ServerConfig config) : world_(world), config_(std::move(config)) {
  if (config_.modules.empty()) config_.modules.assign(world.modules().begin(), world.modules().end());
  for (const std::uint32_t module : config_.modules) {
    hosts_.emplace_back();
    hosts_.back().module = module;
  }
}

WorldServer::~WorldServer() { close("the world ends"); }

Status WorldServer::open() {
  for (const Host& host : hosts_) {
    if (!world_.has(host.module)) return Error{"module " + std::to_string(host.module) + " is not in the world"};
  }
  if (config_.tick < 1ms || config_.tick % 1ms != Duration::zero()) {
    return Error{"tick of " + std::to_string(config_.tick.count()) + " ns: the world steps in whole milliseconds"};
  }
  Result<PacketSocket> listener = listen_at(config_.path);
  if (!listener) return listener.error();
  listener_ = std::move(listener).value();
  return ok();
}

void WorldServer::close(std::string_view reason) {
  Bye bye;
  bye.reason.assign(reason);
  for (Host& host : hosts_) {
    host.socket.send(bye);
    host.socket.close();
  }
  strangers_.clear();
  if (listener_.is_open()) unlink(config_.path.c_str());
  listener_.close();
}

Status WorldServer::run(TimePoint until) {
  if (!listener_.is_open()) return Error{"the world's server is not open"};
  Status status = config_.pace == Pace::lockstep ? run_lockstep(until) : run_wall(until);
  if (!status) close(status.error().message);
  return status;
}

void WorldServer::step(Duration duration) {
  world_.advance(world_.now() + duration);
  ++stats_.ticks;
  if (observer_) observer_(world_, world_.now());
}

/// In the order of the modules, whatever the order of arrival: lockstep runs are repeatable.
void WorldServer::hand_over_answers() {
  for (Host& host : hosts_) {
    if (host.fresh) world_.actuate(host.module, host.answer.frame);
    host.fresh = false;
  }
}

void WorldServer::send_sensors() {
  ++tick_;
  Sensors message;
  message.tick = tick_;
  message.stamp = world_.now();
  for (Host& host : hosts_) {
    if (!host.socket.is_open()) continue;
    message.frame = world_.sense(host.module);
    if (!host.socket.send(message)) ++stats_.unsent_sensors;
  }
}

std::string WorldServer::absent(bool (*missing)(const Host&, std::uint64_t)) const {
  std::string text;
  for (const Host& host : hosts_) {
    if (!missing(host, tick_)) continue;
    text += (text.empty() ? "module " : ", module ") + std::to_string(host.module);
    if (!host.left.empty()) text += " (" + host.left + ")";
  }
  return text;
}

Status WorldServer::run_lockstep(TimePoint until) {
  if (Status joined = wait_for_hosts(); !joined) return joined;
  while (!stopping_ && world_.now() + config_.tick <= until) {
    if (!sent_) send_sensors();
    sent_ = true;
    if (Status answered = wait_for_answers(); !answered) return answered;
    if (stopping_) break;
    sent_ = false;
    hand_over_answers();
    step(config_.tick);
    if (world_.fault()) return *world_.fault();
  }
  return ok();
}

Status WorldServer::wait_for_hosts() {
  const Duration deadline = monotonic_now() + config_.join_timeout;
  while (!stopping_ && hosts_connected() < hosts_.size()) {
    if (monotonic_now() > deadline) {
      return Error{"no hardware host came within " + std::to_string(to_s(config_.join_timeout)) + " s for " +
                   absent([](const Host& host, std::uint64_t) { return !host.socket.is_open(); }) +
                   "; start one that connects to " + config_.path};
    }
    pump(stop_check);
  }
  return ok();
}

Status WorldServer::wait_for_answers() {
  const auto is_missing = [](const Host& host, std::uint64_t tick) { return host.answered_tick != tick; };
  const Duration deadline = monotonic_now() + config_.stall_timeout;
  while (!stopping_) {
    bool waiting = false, gone = false;
    for (const Host& host : hosts_) {
      if (!is_missing(host, tick_)) continue;
      waiting = true;
      gone = gone || !host.socket.is_open();
    }
    if (!waiting) return ok();
    const auto when = [&] { return " at tick " + std::to_string(tick_); };
    if (gone) {
      return Error{"lost a hardware host" + when() + ": " +
                   absent([](const Host& host, std::uint64_t) { return !host.socket.is_open(); })};
    }
    if (monotonic_now() > deadline) {
      return Error{"no actuator frame within " + std::to_string(to_s(config_.stall_timeout)) + " s" + when() +
                   " from " + absent(is_missing)};
    }
    pump(stop_check);
  }
  return ok();
}

Status WorldServer::run_wall(TimePoint until) {
  Duration due = monotonic_now();
  send_sensors();
  while (!stopping_ && world_.now() + config_.tick <= until) {
    due += config_.tick;
    sleep_until(due);
    const std::int64_t missed = std::max(Duration::zero(), monotonic_now() - due) / config_.tick;
    stats_.missed_ticks += static_cast<std::uint64_t>(missed);
    due += missed * config_.tick;
    pump(Duration::zero());
    watch();
    hand_over_answers();
    // Ticks missed are made up for, so that the world's time stays the wall's.
    Duration ahead = std::min((1 + missed) * config_.tick, until - world_.now());
    ahead -= ahead % config_.tick;
    if (ahead > catch_up_max) {
      world_.skip(ahead - catch_up_max);
      ahead = catch_up_max;
    }
    step(ahead);
    if (world_.fault()) return *world_.fault();
    send_sensors();
  }
  return ok();
}

/// Counts late answers, and stands in for the flight board's link watchdog.
void WorldServer::watch() {
  const Duration now = monotonic_now();
  for (Host& host : hosts_) {
    if (!host.alive) continue;
    if (host.answered_tick != tick_) ++stats_.late_answers;
    if (now - host.heard <= config_.watchdog) continue;
    world_.cut(host.module);
    host.alive = false;
    ++stats_.cuts;
  }
}

std::size_t WorldServer::hosts_connected() const {
  return static_cast<std::size_t>(
      std::count_if(hosts_.begin(), hosts_.end(), [](const Host& host) { return host.socket.is_open(); }));
}

}  // namespace eciton::hal::sim
