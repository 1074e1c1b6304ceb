// A chaining transport, as the vendor calls one that stands on another.
#include "core/bus/vendors/fastdds/lean_transport.hpp"

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>

#include "core/bus/vendors/fastdds/lean_size.hpp"

namespace eciton::bus::fastdds {
namespace {

namespace fast = eprosima::fastdds::rtps;
namespace rtps = eprosima::fastrtps::rtps;

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

}  // namespace eciton::bus::fastdds
