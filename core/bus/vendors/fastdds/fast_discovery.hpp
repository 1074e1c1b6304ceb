// Shortens the times at which a participant of Fast DDS repeats what it says of its endpoints.
#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>

namespace eciton::bus::fastdds {

/// Fast DDS tells a participant it discovers of its endpoints at once, and if that was too early, again after 1 s: not
/// configurable in 2.9. Cyclone DDS, which learns of Fast DDS by another thread than it hears that first message with,
/// often misses it, and knew none of our endpoints for 1.0 to 1.3 s (half of 19 mixed processes started together).
/// Here the second becomes 50 ms. Does nothing with a Fast DDS that has no such function to call.
void hasten_discovery(const eprosima::fastdds::dds::DomainParticipant& participant);

}  // namespace eciton::bus::fastdds
