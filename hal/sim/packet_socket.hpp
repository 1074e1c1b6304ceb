// A Unix SOCK_SEQPACKET socket and whole messages on it.
#pragma once

#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "core/base/result.hpp"
#include "core/base/time.hpp"
#include "hal/sim/messages.hpp"

namespace eciton::hal::sim {

/// Owns a file descriptor.
class PacketSocket {
 public:
  PacketSocket() = default;
  explicit PacketSocket(int fd) : fd_(fd) {}
  PacketSocket(PacketSocket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  PacketSocket& operator=(PacketSocket&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~PacketSocket() { close(); }

  int fd() const { return fd_; }
  bool is_open() const { return fd_ >= 0; }
  void close() noexcept;

  /// Never blocks: a full buffer or a peer that is gone is `false`. Real-time safe.
  template <class Message>
  bool send(const Message& message) noexcept {
    return send_bytes(&message, sizeof message);
  }

  struct Received {
    enum class What { message, nothing, closed } what = What::nothing;
    MessageType type{};
    std::size_t size = 0;
  };
  /// The next message into the socket's buffer; never blocks. Real-time safe.
  Received receive() noexcept;
  /// The message just received as what it says it is; nothing when its size is not that type's.
  template <class Message>
  std::optional<Message> as(const Received& received) const {
    if (received.size != sizeof(Message)) return std::nullopt;
    Message message;
    std::memcpy(static_cast<void*>(&message), buffer_, sizeof message);
    return message;
  }

  /// Waits until there is something to receive; false after `timeout`.
  bool wait(Duration timeout) const noexcept;

 private:
  bool send_bytes(const void* data, std::size_t size) noexcept;

  int fd_ = -1;
  alignas(8) unsigned char buffer_[message_size_max];
};

/// Binds and listens. A path that exists is an Error, which says whether someone serves it.
Result<PacketSocket> listen_at(const std::string& path);
Result<PacketSocket> connect_to(const std::string& path);

}  // namespace eciton::hal::sim
