// Packet sockets, made inside each host's namespace and read from here. Only outgoing frames count: on the air each
// is one transmission, however many hear it.
#include "benchmarks/formation/air_ear.hpp"

#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace eciton::bench {
namespace {

constexpr int buffer_bytes = 8 << 20;

int listen_in(const std::filesystem::path& host) {
  const net::InNamespace inside(host);
  const int fd = ::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, htons(ETH_P_ALL));
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_ALL);
  address.sll_ifindex = static_cast<int>(::if_nametoindex(net::radio_interface));
  if (fd < 0 || ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw BadInput{{"host " + host.filename().string() + " cannot be listened to: " + std::strerror(errno) +
                    "; it takes CAP_NET_RAW"}};
  }
  ::setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &buffer_bytes, sizeof buffer_bytes);
  return fd;
}

}  // namespace

AirEar::AirEar(const net::OwnedNet& net, std::uint32_t hosts) : meters_(hosts) {
  for (std::uint32_t host = 1; host <= hosts; ++host) sockets_.push_back(listen_in(net.host(host)));
  thread_ = std::thread([this] { run(); });
}

AirEar::~AirEar() {
  stop_.request();
  thread_.join();
  for (const int fd : sockets_) ::close(fd);
}

void AirEar::run() {
  std::vector<pollfd> wait{{stop_.file_descriptor(), POLLIN, 0}};
  for (const int fd : sockets_) wait.push_back({fd, POLLIN, 0});
  std::array<std::uint8_t, 2048> frame{};
  while (!stop_.requested()) {
    if (::poll(wait.data(), wait.size(), -1) <= 0) continue;
    const std::lock_guard lock(mutex_);
    for (std::size_t k = 0; k < sockets_.size(); ++k) {
      if ((wait[k + 1].revents & POLLIN) == 0) continue;
      while (true) {
        sockaddr_ll from{};
        socklen_t length = sizeof from;
        const ssize_t size = ::recvfrom(sockets_[k], frame.data(), frame.size(), MSG_TRUNC,
                                        reinterpret_cast<sockaddr*>(&from), &length);
        if (size <= 0) break;
        if (from.sll_pkttype != PACKET_OUTGOING) continue;
        const std::size_t kept = std::min(frame.size(), static_cast<std::size_t>(size));
        meters_[k].add(std::span(frame).first(kept), static_cast<std::uint32_t>(size));
      }
    }
  }
}

void AirEar::restart() {
  const std::lock_guard lock(mutex_);
  for (RtpsMeter& meter : meters_) meter.restart();
}

std::vector<RtpsMeter> AirEar::meters() const {
  const std::lock_guard lock(mutex_);
  return meters_;
}

std::uint64_t AirEar::missed() {
  for (const int fd : sockets_) {
    tpacket_stats statistics{};
    socklen_t length = sizeof statistics;
    if (::getsockopt(fd, SOL_PACKET, PACKET_STATISTICS, &statistics, &length) == 0) missed_ += statistics.tp_drops;
  }
  return missed_;
}

}  // namespace eciton::bench
