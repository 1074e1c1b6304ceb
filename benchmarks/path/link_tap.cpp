// Raw messages, one poll for both directions. The tap's own work lies outside the time it measures: it looks at
// the clock last before it sends readings, and first after it received commands.
#include "benchmarks/path/link_tap.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "core/base/wall_clock.hpp"
#include "core/runtime/realtime_thread.hpp"

namespace eciton::bench {
namespace {

using hal::sim::MessageType;

template <class Message>
bool read_as(std::span<const unsigned char> bytes, Message& message) {
  MessageType type{};
  std::memcpy(&type, bytes.data(), sizeof type);
  if (type != Message{}.type || bytes.size() != sizeof message) return false;
  std::memcpy(static_cast<void*>(&message), bytes.data(), sizeof message);
  return true;
}

std::uint64_t print_of(const hal::sim::ActuatorFrame& frame) {
  std::array<RotorPrint, hal::sim::max_rotors> rotors;
  for (std::size_t k = 0; k < rotors.size(); ++k) rotors[k] = {frame.rotors[k].thrust_N, frame.rotors[k].gimbal_rad};
  return command_print(rotors);
}

}  // namespace

LinkTap::LinkTap(TapConfig config, Hook hook) : config_(std::move(config)), hook_(std::move(hook)) {
  ticks_.reserve(config_.ticks_max);
  tick_numbers_.reserve(config_.ticks_max);
}

LinkTap::~LinkTap() {
  close();
  if (listener_.is_open()) ::unlink(config_.host_path.c_str());
}

Status LinkTap::open() {
  auto listener = hal::sim::listen_at(config_.host_path);
  if (!listener) return listener.error();
  listener_ = std::move(listener).value();
  return ok();
}

void LinkTap::close() {
  if (world_ >= 0) ::close(world_);
  if (host_ >= 0) ::close(host_);
  world_ = host_ = -1;
}

void LinkTap::run(const runtime::StopFlag& stop) {
  if (config_.realtime_priority > 0) static_cast<void>(runtime::make_realtime(config_.realtime_priority));
  while (!stop.requested()) {
    if (!connect(stop)) continue;
    while (!stop.requested() && world_ >= 0) pass(stop.file_descriptor());
    close();
  }
}

/// Waits for a host, then for its world.
bool LinkTap::connect(const runtime::StopFlag& stop) {
  std::array<pollfd, 2> wait{{{listener_.fd(), POLLIN, 0}, {stop.file_descriptor(), POLLIN, 0}}};
  if (::poll(wait.data(), wait.size(), -1) <= 0 || stop.requested()) return false;
  host_ = ::accept4(listener_.fd(), nullptr, nullptr, SOCK_CLOEXEC);
  while (host_ >= 0 && !stop.requested()) {
    if (auto world = hal::sim::connect_to(config_.world_path)) {
      world_ = ::dup(world->fd());
      return world_ >= 0;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the world may still be starting
  }
  close();
  return false;
}

void LinkTap::pass(int stop_fd) {
  std::array<pollfd, 3> wait{{{world_, POLLIN, 0}, {host_, POLLIN, 0}, {stop_fd, POLLIN, 0}}};
  if (::poll(wait.data(), wait.size(), -1) <= 0) return;
  const bool world_good = wait[0].revents == 0 || from_world();
  const bool host_good = wait[1].revents == 0 || from_host();
  if (!world_good || !host_good) close();
}

bool LinkTap::from_world() {
  const ssize_t size = ::recv(world_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
  if (size <= 0) return size < 0 && errno == EAGAIN;
  const std::span<const unsigned char> bytes(buffer_.data(), static_cast<std::size_t>(size));
  hal::sim::Sensors sensors;
  const bool tick = read_as(bytes, sensors);
  if (tick && hook_) hook_();
  const std::int64_t now_ns = to_ns(wall_now());
  if (::send(host_, bytes.data(), bytes.size(), MSG_NOSIGNAL) != size) return false;
  if (tick && recording_ && ticks_.size() < config_.ticks_max) {
    ticks_.push_back({.imu_stamp_ns = to_ns(sensors.frame.imu.stamp), .out_ns = now_ns, .in_ns = 0, .command = 0});
    tick_numbers_.push_back(sensors.tick);
  }
  passed_ += tick ? 1 : 0;
  return true;
}

bool LinkTap::from_host() {
  const ssize_t size = ::recv(host_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
  const std::int64_t now_ns = to_ns(wall_now());
  if (size <= 0) return size < 0 && errno == EAGAIN;
  const std::span<const unsigned char> bytes(buffer_.data(), static_cast<std::size_t>(size));
  if (::send(world_, bytes.data(), bytes.size(), MSG_NOSIGNAL) != size) return false;
  hal::sim::Actuators actuators;
  if (!read_as(bytes, actuators)) return true;
  for (std::size_t k = ticks_.size(); k-- > 0 && tick_numbers_[k] >= actuators.tick;) {
    if (tick_numbers_[k] != actuators.tick) continue;
    ticks_[k].in_ns = now_ns;
    ticks_[k].command = print_of(actuators.frame);
  }
  if (hook_) hook_();
  return true;
}

}  // namespace eciton::bench
