// Datagrams of lines, NAME=value.
#include "deploy/supervisor/notify_socket.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace eciton::deploy {
namespace {

constexpr int messages_at_once = 1000;  // more than the kernel queues

void read_lines(std::string_view text, NotifySocket::Notices& notices) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line == "READY=1") notices.ready = true;
    if (line == "WATCHDOG=1") notices.alive = true;
    if (line == "STOPPING=1") notices.stopping = true;
  }
}

}  // namespace

Result<NotifySocket> NotifySocket::open(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.native().size() >= sizeof address.sun_path) {
    return Error{"notify socket " + path.string() + ": the path is longer than a socket's may be (" +
                 std::to_string(sizeof address.sun_path - 1) + "); set ECITON_RUNTIME_DIR to a shorter one"};
  }
  std::memcpy(address.sun_path, path.c_str(), path.native().size());
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) return Error{"notify socket " + path.string() + " cannot be made: " + std::strerror(errno)};
  NotifySocket made(path, socket);
  ::unlink(path.c_str());
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return Error{"notify socket " + path.string() + " cannot be bound: " + std::strerror(errno)};
  }
  return made;
}

NotifySocket::NotifySocket(NotifySocket&& other) noexcept
    : path_(std::move(other.path_)), socket_(std::exchange(other.socket_, -1)) {}

NotifySocket& NotifySocket::operator=(NotifySocket&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(socket_, other.socket_);
  return *this;
}

NotifySocket::~NotifySocket() {
  if (socket_ < 0) return;
  ::close(socket_);
  ::unlink(path_.c_str());
}

NotifySocket::Notices NotifySocket::take() {
  Notices notices;
  std::array<char, 4096> message{};
  for (int k = 0; k < messages_at_once; ++k) {
    const ssize_t size = ::recv(socket_, message.data(), message.size(), MSG_DONTWAIT);
    if (size < 0) break;
    read_lines({message.data(), static_cast<std::size_t>(size)}, notices);
  }
  return notices;
}

}  // namespace eciton::deploy
