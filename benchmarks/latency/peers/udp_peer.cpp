// The floor: the payload as it lies in memory in one datagram, a thread blocked in recv, no library between.
#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <thread>

#include "benchmarks/latency/peers/raw_payload.hpp"
#include "benchmarks/latency/peers/transport.hpp"
#include "core/base/result.hpp"
#include "core/bus/vendors/network.hpp"

namespace eciton::bench {
namespace {

class UdpTransport final : public Transport {
 public:
  UdpTransport(const PeerOptions& options, Sink& sink) : sink_(sink), socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    here_.sin_family = AF_INET;
    const std::string own = value_or_throw(bus::vendors::interface_address(options.network_interface));
    ::inet_pton(AF_INET, own.c_str(), &here_.sin_addr);
    const int buffer_bytes = 1 << 20;  // as both vendors' plugins ask for
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &buffer_bytes, sizeof buffer_bytes);
    socklen_t size = sizeof here_;
    if (socket_ < 0 || ::bind(socket_, reinterpret_cast<const sockaddr*>(&here_), size) != 0 ||
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&here_), &size) != 0) {
      throw BadInput{{"no UDP socket on " + options.network_interface + ": " + std::strerror(errno)}};
    }
    std::thread([this] { receive_all(); }).detach();
  }

  std::string address() const override {
    char text[INET_ADDRSTRLEN] = "";
    ::inet_ntop(AF_INET, &here_.sin_addr, text, sizeof text);
    return std::string(text) + ":" + std::to_string(ntohs(here_.sin_port));
  }
  void connect(const std::string& address) override {
    const std::size_t colon = address.find(':');
    sockaddr_in there{};
    there.sin_family = AF_INET;
    there.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(colon + 1))));
    ::inet_pton(AF_INET, address.substr(0, colon).c_str(), &there.sin_addr);
    ::connect(socket_, reinterpret_cast<const sockaddr*>(&there), sizeof there);
  }
  void select(std::uint32_t bytes) override { out_.resize(bytes); }
  bool send(const Mark& mark) noexcept override {
    const auto bytes = out_.with(mark);
    return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }

 private:
  void receive_all() {
    std::array<std::byte, payload_sizes.back()> in;
    for (;;) {
      const ssize_t size = ::recv(socket_, in.data(), in.size(), 0);
      if (size > 0) give({in.data(), static_cast<std::size_t>(size)}, sink_);
    }
  }

  Sink& sink_;
  int socket_;
  sockaddr_in here_{};
  RawPayload out_;
};

std::unique_ptr<Transport> make(const PeerOptions& options, Sink& sink) {
  return std::make_unique<UdpTransport>(options, sink);
}

}  // namespace
}  // namespace eciton::bench

int main(int argc, char** argv) { return eciton::bench::peer_main(argc, argv, eciton::bench::make); }
