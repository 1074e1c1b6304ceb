// Unix sockets, message by message.
#include "benchmarks/formation/member_link.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace eciton::bench {
namespace {

eciton::Result<sockaddr_un> address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string text = path.string();
  if (text.size() >= sizeof address.sun_path) {
    return Error{"socket " + text + ": the path is too long; set ECITON_RUNTIME_DIR to a shorter one"};
  }
  std::copy(text.begin(), text.end(), address.sun_path);
  return address;
}

Error failed(const char* what, const std::filesystem::path& path) {
  return Error{"socket " + path.string() + " cannot be " + what + ": " + std::strerror(errno)};
}

}  // namespace

MemberLink::MemberLink(MemberLink&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
MemberLink& MemberLink::operator=(MemberLink&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}
MemberLink::~MemberLink() {
  if (fd_ >= 0) ::close(fd_);
}

eciton::Result<MemberLink> MemberLink::connect(const std::filesystem::path& path) {
  const auto address = address_of(path);
  if (!address) return address.error();
  MemberLink link(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  if (::connect(link.fd_, reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0) {
    return failed("reached", path);
  }
  return link;
}

bool MemberLink::send_bytes(const void* data, std::size_t size) {
  return fd_ >= 0 && ::send(fd_, data, size, MSG_DONTWAIT | MSG_NOSIGNAL) == static_cast<ssize_t>(size);
}

/// False: nothing is there, or the other side is gone, which closes this one.
bool MemberLink::receive(void* data, std::size_t size) {
  if (fd_ < 0) return false;
  const ssize_t got = ::recv(fd_, data, size, MSG_DONTWAIT);
  if (got == static_cast<ssize_t>(size)) return true;
  if (got >= 0 || (errno != EAGAIN && errno != EINTR)) ::close(std::exchange(fd_, -1));
  return false;
}

std::optional<MemberOrder> MemberLink::take_order() {
  MemberOrder order;
  return receive(&order, sizeof order) ? std::optional(order) : std::nullopt;
}
std::optional<MemberNews> MemberLink::take_news() {
  MemberNews news;
  return receive(&news, sizeof news) ? std::optional(news) : std::nullopt;
}

eciton::Result<MemberListener> MemberListener::open(const std::filesystem::path& path) {
  const auto address = address_of(path);
  if (!address) return address.error();
  MemberListener listener(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0), path);
  ::unlink(path.c_str());
  constexpr int backlog = 64;
  if (::bind(listener.fd_, reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0 ||
      ::listen(listener.fd_, backlog) != 0) {
    return failed("opened", path);
  }
  return listener;
}

MemberListener::MemberListener(MemberListener&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), path_(std::move(other.path_)) {}
MemberListener::~MemberListener() {
  if (fd_ < 0) return;
  ::close(fd_);
  ::unlink(path_.c_str());
}

std::optional<MemberLink> MemberListener::accept() {
  const int fd = ::accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC);
  if (fd < 0) return std::nullopt;
  return MemberLink(fd);
}

}  // namespace eciton::bench
