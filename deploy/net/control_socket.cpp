// Non-blocking on the relay's side, with time-outs on the clients'.
#include "deploy/net/control_socket.hpp"

#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace eciton::net {
namespace {

constexpr std::size_t request_bytes_max = 4096;
constexpr int patience_s = 3;

Error failed(const std::filesystem::path& path, const char* what) {
  return Error{"control socket " + path.string() + " " + what + ": " + std::strerror(errno)};
}

bool fill(sockaddr_un& address, const std::filesystem::path& path) {
  if (path.string().size() >= sizeof address.sun_path) return false;
  address.sun_family = AF_UNIX;
  std::strcpy(address.sun_path, path.c_str());
  return true;
}

}  // namespace

Result<ControlServer> ControlServer::listen(const std::filesystem::path& path) {
  sockaddr_un address{};
  if (!fill(address, path)) return Error{"control socket " + path.string() + ": the path is too long"};
  const int listener = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int epoll = ::epoll_create1(EPOLL_CLOEXEC);
  ControlServer server(listener, epoll);
  epoll_event readable{.events = EPOLLIN, .data = {.fd = listener}};
  if (listener < 0 || epoll < 0 || ::bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener, 16) != 0 || ::epoll_ctl(epoll, EPOLL_CTL_ADD, listener, &readable) != 0) {
    return failed(path, "cannot be opened");
  }
  return server;
}

ControlServer::ControlServer(ControlServer&& other) noexcept
    : listener_(std::exchange(other.listener_, -1)),
      epoll_(std::exchange(other.epoll_, -1)),
      clients_(std::exchange(other.clients_, {})) {}

ControlServer::~ControlServer() {
  for (Client& client : clients_) drop(client);
  if (listener_ >= 0) ::close(listener_);
  if (epoll_ >= 0) ::close(epoll_);
}

void ControlServer::serve(const Answer& answer) {
  std::array<epoll_event, 4> events{};
  const int count = ::epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), 0);
  for (int k = 0; k < count; ++k) {
    const int fd = events[static_cast<std::size_t>(k)].data.fd;
    if (fd == listener_) {
      accept_client();
      continue;
    }
    const auto client = std::find_if(clients_.begin(), clients_.end(), [fd](const Client& c) { return c.fd == fd; });
    if (client != clients_.end()) serve(*client, answer);
  }
}

void ControlServer::accept_client() {
  const int fd = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd < 0) return;
  const auto free = std::find_if(clients_.begin(), clients_.end(), [](const Client& c) { return c.fd < 0; });
  epoll_event readable{.events = EPOLLIN, .data = {.fd = fd}};
  if (free == clients_.end() || ::epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &readable) != 0) {
    ::close(fd);
    return;
  }
  free->fd = fd;
}

void ControlServer::serve(Client& client, const Answer& answer) {
  std::array<char, 1024> block{};
  if (!client.answered) {
    const ssize_t got = ::recv(client.fd, block.data(), block.size(), 0);
    if (got < 0 && errno == EAGAIN) return;
    if (got <= 0 || client.request.size() > request_bytes_max) return drop(client);
    client.request.append(block.data(), static_cast<std::size_t>(got));
    const std::size_t end = client.request.find('\n');
    if (end == std::string::npos) return;
    client.reply = answer(client.request.substr(0, end)) + "\n";
    client.answered = true;
    epoll_event writable{.events = EPOLLOUT, .data = {.fd = client.fd}};
    ::epoll_ctl(epoll_, EPOLL_CTL_MOD, client.fd, &writable);
  }
  const ssize_t sent = ::send(client.fd, client.reply.data(), client.reply.size(), MSG_NOSIGNAL);
  if (sent < 0 && errno == EAGAIN) return;
  if (sent > 0) client.reply.erase(0, static_cast<std::size_t>(sent));
  if (sent <= 0 || client.reply.empty()) drop(client);
}

void ControlServer::drop(Client& client) {
  if (client.fd >= 0) ::close(client.fd);
  client = {};
}

Result<std::string> ask(const std::filesystem::path& path, const std::string& line) {
  sockaddr_un address{};
  if (!fill(address, path)) return Error{"control socket " + path.string() + ": the path is too long"};
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return failed(path, "cannot be reached");
  const timeval patience{.tv_sec = patience_s, .tv_usec = 0};
  ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  ::setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  const std::string request = line + "\n";
  std::string reply;
  ssize_t got = -1;
  if (::connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
      ::send(fd, request.data(), request.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(request.size())) {
    std::array<char, 4096> block{};
    while ((got = ::recv(fd, block.data(), block.size(), 0)) > 0)
      reply.append(block.data(), static_cast<std::size_t>(got));
  }
  const int why = errno;
  ::close(fd);
  errno = why;
  if (got < 0) return failed(path, "does not answer");
  if (reply.empty() || reply.back() != '\n') {
    return Error{"control socket " + path.string() + ": the relay ended before it had answered"};
  }
  reply.pop_back();
  return reply;
}

}  // namespace eciton::net
