// What a participant puts on the wire, heard by a plain socket that its announcements go to.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <vector>

#include "tests/core/bus/vendors/plugin_handles.hpp"

namespace eciton::bus {
namespace {

constexpr std::uint8_t info_timestamp = 0x09, info_destination = 0x0e, data = 0x15;

/// Bound to the discovery port of a participant that does not exist.
class DiscoveryPort {
 public:
  DiscoveryPort(std::uint32_t domain, int participant) : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * domain + 10 + 2 * participant));
    const timeval at_most{10, 0};
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &at_most, sizeof at_most);
    bound_ = ::bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~DiscoveryPort() { ::close(fd_); }

  bool bound() const { return bound_; }
  std::vector<std::uint8_t> next() const {
    std::vector<std::uint8_t> message(65536);
    const auto size = ::recv(fd_, message.data(), message.size(), 0);
    message.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
    return message;
  }

 private:
  int fd_;
  bool bound_ = false;
};

std::vector<std::uint8_t> submessages(const std::vector<std::uint8_t>& message) {
  constexpr std::size_t header = 20;
  std::vector<std::uint8_t> ids;
  for (std::size_t at = header; at + 4 <= message.size();) {
    ids.push_back(message[at]);
    const bool little = (message[at + 1] & 1) != 0;
    const std::size_t length = message[at + 2 + (little ? 0 : 1)] + 256u * message[at + 2 + (little ? 1 : 0)];
    if (length == 0) break;  // to the end
    at += 4 + length;
  }
  return ids;
}

class WireTest : public testing::TestWithParam<const char*> {};

TEST_P(WireTest, CarriesNothingBesideWhatTheProtocolAsksFor) {
  const DiscoveryPort port(domain_of_this_run(), 30);
  ASSERT_TRUE(port.bound());
  TestParticipant participant(GetParam(), domain_of_this_run(), {"127.0.0.1"});
  ASSERT_NE(participant.handle(), nullptr) << participant.error();
  const std::vector<std::uint8_t> message = port.next();
  ASSERT_GE(message.size(), 20u) << "no announcement came";
  EXPECT_EQ(std::string(message.begin(), message.begin() + 4), "RTPS");
  bool announced = false;
  for (const std::uint8_t id : submessages(message)) {
    announced |= id == data;
    EXPECT_TRUE(id == info_timestamp || id == info_destination || id == data) << "submessage " << int{id};
  }
  EXPECT_TRUE(announced);
}

INSTANTIATE_TEST_SUITE_P(Vendors, WireTest, testing::Values("fastdds", "cyclonedds"),
                         [](const auto& vendor) { return std::string(vendor.param); });

}  // namespace
}  // namespace eciton::bus
