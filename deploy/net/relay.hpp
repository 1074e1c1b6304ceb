// Moves frames between the hosts' TAP devices as the air says: the process in which a net lives.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/runtime/stop_signal.hpp"
#include "deploy/net/air.hpp"
#include "deploy/net/control_socket.hpp"
#include "deploy/net/tap.hpp"

namespace eciton::net {

/// Bytes of frames in flight; a slot is free again when all its flights have landed. Real-time safe.
class FramePool {
 public:
  static constexpr std::uint32_t slots = 8192;

  using Bytes = std::array<std::uint8_t, 2048>;

  FramePool();
  /// Frame::no_slot when all are in use.
  std::uint32_t acquire();
  Bytes& bytes(std::uint32_t slot) { return frames_[slot].bytes; }
  /// As many flights will use it; 0 frees it.
  void set_uses(std::uint32_t slot, std::uint32_t uses);
  void release(std::uint32_t slot);

 private:
  struct Stored {
    Bytes bytes;
    std::uint32_t uses = 0;
  };
  std::vector<Stored> frames_;
  std::vector<std::uint32_t> free_;
};

class Relay {
 public:
  /// Taps in the order of the air's hosts.
  Relay(Air& air, std::vector<Tap> taps, ControlServer control);
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  /// Until the flag is set or someone asks for the end.
  void run(runtime::StopFlag& stop);

 private:
  void take_frames(std::uint32_t host);
  bool take_frame(std::uint32_t host);
  void land_all_due();
  void set_timer();

  Air& air_;
  std::vector<Tap> taps_;
  ControlServer control_;
  FramePool pool_;
  FramePool::Bytes scratch_{};  // for frames that are read only to be dropped
  int epoll_ = -1;
  int timer_ = -1;
  Duration timer_due_{};
};

}  // namespace eciton::net
