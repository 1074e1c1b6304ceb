// A chaining transport, as the vendor calls one that stands on another.
#include "core/bus/vendors/fastdds/lean_transport.hpp"

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>

namespace eciton::bus::fastdds {
namespace {

namespace fast = eprosima::fastdds::rtps;
namespace rtps = eprosima::fastrtps::rtps;

constexpr std::uint32_t kMessageHeader = 20, kSubmessageHeader = 4, kStatistics = 56;
constexpr std::uint8_t kStatisticsId = 0x80;

class LeanTransport final : public fast::ChainingTransport {
 public:
  using ChainingTransport::ChainingTransport;

  fast::TransportDescriptorInterface* get_configuration() override {
    return low_level_transport_->get_configuration();
  }

  bool send(rtps::SenderResource* sender, const rtps::octet* message, std::uint32_t size,
            rtps::LocatorsIterator* begin, rtps::LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& until) override {
    return sender->send(message, lean_size(message, size), begin, end, until);
  }

  void receive(fast::TransportReceiverInterface* next, const rtps::octet* message, std::uint32_t size,
               const rtps::Locator_t& local, const rtps::Locator_t& remote) override {
    next->OnDataReceived(message, size, local, remote);
  }
};

struct LeanTransportDescriptor final : fast::ChainingTransportDescriptor {
  using ChainingTransportDescriptor::ChainingTransportDescriptor;
  fast::TransportInterface* create_transport() const override { return new LeanTransport(*this); }
};

}  // namespace

std::shared_ptr<fast::TransportDescriptorInterface> lean_transport(
    std::shared_ptr<fast::UDPv4TransportDescriptor> udp) {
  return std::make_shared<LeanTransportDescriptor>(std::move(udp));
}

std::uint32_t lean_size(const std::uint8_t* message, std::uint32_t size) {
  constexpr std::uint32_t tail_size = kSubmessageHeader + kStatistics;
  if (size < kMessageHeader + tail_size) return size;
  const std::uint8_t* tail = message + size - tail_size;
  const std::uint32_t length = (tail[1] & 1) != 0 ? tail[2] + 256u * tail[3] : tail[3] + 256u * tail[2];
  return tail[0] == kStatisticsId && length == kStatistics ? size - tail_size : size;
}

}  // namespace eciton::bus::fastdds
