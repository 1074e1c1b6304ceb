// Unix sockets, message by message.
#include "hal/sim/packet_socket.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace eciton::hal::sim {
namespace {

Result<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    return Error{"socket path '" + path + "' has " + std::to_string(path.size()) +
                 " characters; a Unix socket takes 1 to " + std::to_string(sizeof address.sun_path - 1)};
  }
  std::copy(path.begin(), path.end(), address.sun_path);
  return address;
}

std::string failure(const char* what, const std::string& path) {
  return std::string(what) + " the world's socket " + path + ": " + std::strerror(errno);
}

int connect_fd(int fd, const sockaddr_un& address) {
  return connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

}  // namespace

void PacketSocket::close() noexcept {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

bool PacketSocket::send_bytes(const void* data, std::size_t size) noexcept {
  return fd_ >= 0 && ::send(fd_, data, size, MSG_DONTWAIT | MSG_NOSIGNAL) == static_cast<ssize_t>(size);
}

PacketSocket::Received PacketSocket::receive() noexcept {
  using What = Received::What;
  if (fd_ < 0) return {.what = What::closed};
  const ssize_t size = recv(fd_, buffer_, sizeof buffer_, MSG_DONTWAIT);
  if (size < 0) {
    const bool later = errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    return {.what = later ? What::nothing : What::closed};
  }
  if (size == 0) return {.what = What::closed};
  Received received{.what = What::message, .size = static_cast<std::size_t>(size)};
  if (received.size >= sizeof received.type) std::memcpy(&received.type, buffer_, sizeof received.type);
  return received;
}

bool PacketSocket::wait(Duration timeout) const noexcept {
  pollfd entry{.fd = fd_, .events = POLLIN, .revents = 0};
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(std::max(timeout, Duration::zero())).count();
  return poll(&entry, 1, static_cast<int>(std::min<long>(ms, 3'600'000))) > 0;
}

Result<PacketSocket> listen_at(const std::string& path) {
  const Result<sockaddr_un> address = address_of(path);
  if (!address) return address.error();
  PacketSocket socket(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket.is_open()) return Error{failure("cannot make", path)};
  if (bind(socket.fd(), reinterpret_cast<const sockaddr*>(&*address), sizeof(sockaddr_un)) != 0) {
    if (errno != EADDRINUSE) return Error{failure("cannot bind", path)};
    const PacketSocket probe(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
    if (connect_fd(probe.fd(), *address) == 0) {
      return Error{"the world's socket " + path +
                   " is in use by another world; stop it or give this one another path"};
    }
    return Error{"the world's socket " + path +
                 " already exists, though nobody serves it; remove the file or give another path"};
  }
  if (listen(socket.fd(), 32) != 0) {
    const Error error{failure("cannot listen at", path)};
    unlink(path.c_str());
    return error;
  }
  return socket;
}

Result<PacketSocket> connect_to(const std::string& path) {
  const Result<sockaddr_un> address = address_of(path);
  if (!address) return address.error();
  PacketSocket socket(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  if (!socket.is_open()) return Error{failure("cannot make", path)};
  if (connect_fd(socket.fd(), *address) != 0) return Error{failure("cannot reach", path) + "; is the world running?"};
  return socket;
}

}  // namespace eciton::hal::sim
