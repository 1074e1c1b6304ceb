// One thread, one epoll: TAP devices, the timer of the next flight, the control socket. Nothing here waits but the
// poll itself.
#include "deploy/net/relay.hpp"

#include <fcntl.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/base/wall_clock.hpp"
#include "deploy/net/requests.hpp"

namespace eciton::net {
namespace {

constexpr int frames_per_turn = 16;  // of one host, before the others have theirs
constexpr std::uint32_t timer_id = 1000, control_id = 1001, stop_id = 1002;

// Offsets in an Ethernet frame.
constexpr std::size_t type_at = 12, ipv4_protocol_at = 23, ethernet_header_bytes = 14;

/// IGMP and IPv6 are kept off the air: every host hears every multicast anyway, and what the kernels send of their
/// own at times of their own would make a seeded run another one.
bool belongs_on_the_air(const std::uint8_t* frame, std::size_t size) {
  const unsigned type = frame[type_at] << 8 | frame[type_at + 1];
  if (type == 0x0800) return size > ipv4_protocol_at && frame[ipv4_protocol_at] != 2;
  return type == 0x0806;  // ARP, for addresses beside the hosts' own
}

}  // namespace

FramePool::FramePool() : frames_(slots) {
  free_.reserve(slots);
  for (std::uint32_t slot = slots; slot > 0; --slot) free_.push_back(slot - 1);
}

std::uint32_t FramePool::acquire() {
  if (free_.empty()) return Frame::no_slot;
  const std::uint32_t slot = free_.back();
  free_.pop_back();
  return slot;
}

void FramePool::set_uses(std::uint32_t slot, std::uint32_t uses) {
  frames_[slot].uses = uses;
  if (uses == 0) free_.push_back(slot);
}

void FramePool::release(std::uint32_t slot) {
  if (--frames_[slot].uses == 0) free_.push_back(slot);
}

Relay::Relay(Air& air, std::vector<Tap> taps, ControlServer control)
    : air_(air), taps_(std::move(taps)), control_(std::move(control)) {
  epoll_ = ::epoll_create1(EPOLL_CLOEXEC);
  timer_ = ::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
  bool well = epoll_ >= 0 && timer_ >= 0;
  const auto add = [&](int fd, std::uint32_t id) {
    epoll_event readable{.events = EPOLLIN, .data = {.u32 = id}};
    well = well && ::epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &readable) == 0;
  };
  for (std::uint32_t host = 0; host < taps_.size(); ++host) add(taps_[host].file_descriptor(), host);
  add(timer_, timer_id);
  add(control_.file_descriptor(), control_id);
  if (!well) throw BadInput{{std::string("the relay cannot poll its devices: ") + std::strerror(errno)}};
}

Relay::~Relay() {
  if (epoll_ >= 0) ::close(epoll_);
  if (timer_ >= 0) ::close(timer_);
}

void Relay::run(runtime::StopFlag& stop) {
  ::prctl(PR_SET_TIMERSLACK, 1);
  epoll_event readable{.events = EPOLLIN, .data = {.u32 = stop_id}};
  ::epoll_ctl(epoll_, EPOLL_CTL_ADD, stop.file_descriptor(), &readable);
  std::array<epoll_event, 32> events{};
  while (!stop.requested()) {
    const int count = ::epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), -1);
    if (count < 0 && errno != EINTR) return;
    for (int k = 0; k < count; ++k) {
      const std::uint32_t id = events[static_cast<std::size_t>(k)].data.u32;
      if (id < taps_.size()) {
        take_frames(id);
      } else if (id == timer_id) {
        std::uint64_t expirations = 0;
        [[maybe_unused]] const auto got = ::read(timer_, &expirations, sizeof expirations);
        timer_due_ = Duration::zero();
      } else if (id == control_id) {
        bool asked_to_end = false;
        control_.serve([&](const std::string& line) { return answer(air_, line, asked_to_end); });
        if (asked_to_end) stop.request();
      }
    }
    land_all_due();
    set_timer();
  }
}

void Relay::take_frames(std::uint32_t host) {
  for (int taken = 0; taken < frames_per_turn; ++taken) {
    if (!take_frame(host)) return;
    land_all_due();
  }
}

/// False: there is none.
bool Relay::take_frame(std::uint32_t host) {
  const std::uint32_t slot = pool_.acquire();
  auto& bytes = slot == Frame::no_slot ? scratch_ : pool_.bytes(slot);
  const ssize_t size = ::read(taps_[host].file_descriptor(), bytes.data(), bytes.size());
  std::uint32_t flights = 0;
  if (size >= static_cast<ssize_t>(ethernet_header_bytes) &&
      belongs_on_the_air(bytes.data(), static_cast<std::size_t>(size))) {
    const bool to_all = (bytes[0] & 1) != 0;
    const auto to = host_with_mac(bytes.data(), static_cast<std::uint32_t>(taps_.size() - 1));
    if (to_all || to) {
      flights = air_.send(
          {.from = host, .to = to_all ? std::nullopt : to, .bytes = static_cast<std::uint32_t>(size), .slot = slot},
          monotonic_now());
    }
  }
  if (slot != Frame::no_slot) pool_.set_uses(slot, flights);
  return size > 0;
}

void Relay::land_all_due() {
  if (!air_.next_due()) return;
  const Duration now = monotonic_now();
  while (const auto flight = air_.land(now)) {
    const auto& bytes = pool_.bytes(flight->slot);
    if (::write(taps_[flight->to].file_descriptor(), bytes.data(), flight->bytes) < 0) air_.refuse(*flight);
    pool_.release(flight->slot);
  }
}

void Relay::set_timer() {
  const auto due = air_.next_due();
  if (!due || *due == timer_due_) return;
  timer_due_ = *due;
  const itimerspec at{.it_interval = {}, .it_value = {.tv_sec = *due / 1s, .tv_nsec = (*due % 1s).count()}};
  ::timerfd_settime(timer_, TFD_TIMER_ABSTIME, &at, nullptr);
}

}  // namespace eciton::net
