// Binds and listens, so that a later one can connect and ask the kernel whose socket it is.
#include "deploy/supervisor/host_claim.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

namespace eciton::deploy {
namespace {

// Those who asked stay in the queue, since nobody accepts them; when it is full the holder goes unnamed.
constexpr int backlog = 1024;

/// The process that listens at an address, 0 if that cannot be found out.
pid_t listener(const sockaddr_un& address, socklen_t size) {
  const int probe = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (probe < 0) return 0;
  ucred peer{};
  socklen_t peer_size = sizeof peer;
  const bool known = ::connect(probe, reinterpret_cast<const sockaddr*>(&address), size) == 0 &&
                     ::getsockopt(probe, SOL_SOCKET, SO_PEERCRED, &peer, &peer_size) == 0;
  ::close(probe);
  return known ? peer.pid : 0;
}

}  // namespace

Result<HostClaim> HostClaim::take(const std::string& what) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = "eciton/" + what;
  if (name.size() + 1 > sizeof address.sun_path) return Error{what + ": the name is too long to be claimed"};
  std::memcpy(address.sun_path + 1, name.data(), name.size());  // the leading zero makes it abstract: no file
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) return Error{what + " cannot be claimed: " + std::strerror(errno)};
  HostClaim claim(socket);
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), size) == 0 && ::listen(socket, backlog) == 0)
    return claim;
  if (errno != EADDRINUSE) return Error{what + " cannot be claimed: " + std::strerror(errno)};
  const pid_t holder = listener(address, size);
  return Error{what + " is already in use on this host" +
               (holder > 0 ? " by process " + std::to_string(holder) : std::string())};
}

HostClaim::HostClaim(HostClaim&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}

HostClaim& HostClaim::operator=(HostClaim&& other) noexcept {
  std::swap(socket_, other.socket_);
  return *this;
}

HostClaim::~HostClaim() {
  if (socket_ >= 0) ::close(socket_);
}

}  // namespace eciton::deploy
