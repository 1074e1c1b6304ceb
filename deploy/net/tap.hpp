// A host's end of the radio: a TAP device called eth0 in its namespace, whose other end the relay holds.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "deploy/net/hosts.hpp"

namespace eciton::net {

inline constexpr std::size_t frame_bytes_max = 1514;  // an MTU of 1500 and the Ethernet header

/// Gone, with all it carried, when its holder ends.
class Tap {
 public:
  /// Makes and configures the interfaces of a host: eth0 with address, multicast and the others as neighbours, and
  /// lo.
  static Result<Tap> open(const std::string& net, std::uint32_t index, std::uint32_t modules);

  Tap(Tap&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Tap& operator=(Tap&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Tap();
  int file_descriptor() const { return fd_; }

 private:
  explicit Tap(int fd) : fd_(fd) {}
  int fd_ = -1;
};

/// Gives a host's eth0 another address, live: as if its lease had run out.
Status set_address(const std::string& net, std::uint32_t index, std::uint32_t modules, const std::string& address);

using MacAddress = std::array<std::uint8_t, 6>;
MacAddress host_mac(std::uint32_t index);
/// Nothing: not a host's.
std::optional<std::uint32_t> host_with_mac(const std::uint8_t* mac, std::uint32_t modules);

}  // namespace eciton::net
