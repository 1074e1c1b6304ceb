// Datagrams between hosts, numbered and stamped: what arrived, how often, and after how long.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/wall_clock.hpp"
#include "deploy/net/hosts.hpp"

namespace eciton::net {

struct Datagram {
  std::uint32_t number = 0;
  Duration delay{};  // from the send call to the receive call, both in this process
};

/// A UDP socket in a host.
class Udp {
 public:
  static constexpr std::uint16_t port = 5000;

  /// Bound to all addresses; multicast goes over `interface_address` and is heard there.
  Udp(const std::filesystem::path& host, const std::string& interface_address) {
    const InNamespace inside(host);
    fd_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const int on = 1, buffer_bytes = 4 << 20;
    ::setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUFFORCE, &buffer_bytes, sizeof buffer_bytes);
    const sockaddr_in all = address("0.0.0.0");
    if (::bind(fd_, reinterpret_cast<const sockaddr*>(&all), sizeof all) != 0) std::perror("bind");
    const ip_mreq group{.imr_multiaddr = address(group_address).sin_addr,
                        .imr_interface = address(interface_address).sin_addr};
    if (::setsockopt(fd_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0) std::perror("join");
    ::setsockopt(fd_, IPPROTO_IP, IP_MULTICAST_IF, &group.imr_interface, sizeof group.imr_interface);
  }
  Udp(Udp&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  ~Udp() {
    if (fd_ >= 0) ::close(fd_);
  }

  static constexpr const char* group_address = "239.255.0.1";

  void send(const std::string& to, std::uint32_t number, std::size_t bytes = 100) {
    std::vector<char> payload(bytes);
    const std::int64_t now_ns = monotonic_now().count();
    std::memcpy(payload.data(), &number, sizeof number);
    std::memcpy(payload.data() + 8, &now_ns, sizeof now_ns);
    const sockaddr_in where = address(to);
    ::sendto(fd_, payload.data(), payload.size(), 0, reinterpret_cast<const sockaddr*>(&where), sizeof where);
  }

  std::optional<Datagram> receive(Duration patience) {
    pollfd readable{fd_, POLLIN, 0};
    ::poll(&readable, 1, static_cast<int>(patience / 1ms));
    char payload[2000];
    if (::recv(fd_, payload, sizeof payload, 0) < 16) return std::nullopt;
    Datagram datagram;
    std::int64_t sent_ns = 0;
    std::memcpy(&datagram.number, payload, sizeof datagram.number);
    std::memcpy(&sent_ns, payload + 8, sizeof sent_ns);
    datagram.delay = monotonic_now() - Duration{sent_ns};
    return datagram;
  }
  /// All that arrives until nothing has for `quiet`.
  std::vector<Datagram> receive_all(Duration quiet = 300ms) {
    std::vector<Datagram> all;
    while (const auto datagram = receive(quiet)) all.push_back(*datagram);
    return all;
  }

 private:
  static sockaddr_in address(const std::string& text) {
    sockaddr_in result{};
    result.sin_family = AF_INET;
    result.sin_port = htons(port);
    ::inet_pton(AF_INET, text.c_str(), &result.sin_addr);
    return result;
  }

  int fd_ = -1;
};

/// Sends numbered datagrams in small batches, so that no queue on the way overflows.
inline void send_stream(Udp& from, const std::string& to, std::uint32_t count, std::size_t bytes = 100) {
  for (std::uint32_t number = 0; number < count; ++number) {
    if (number % 10 == 9) std::this_thread::sleep_for(1ms);
    from.send(to, number, bytes);
  }
}

}  // namespace eciton::net
