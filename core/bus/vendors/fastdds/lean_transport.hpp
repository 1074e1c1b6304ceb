// The vendor's UDP, less the 60 bytes that it appends to every message for statistics which nobody gathers: they are
// compiled in (FASTDDS_STATISTICS), and no setting takes them away. They were a quarter of an idle module's beacon
// on the air.
#pragma once

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <memory>

namespace eciton::bus::fastdds {

/// What stands on top of `udp`.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> lean_transport(
    std::shared_ptr<eprosima::fastdds::rtps::UDPv4TransportDescriptor> udp);

}  // namespace eciton::bus::fastdds
