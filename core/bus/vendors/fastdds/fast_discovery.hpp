// Shortens the times after which a participant of Fast DDS repeats what it says of itself and of its endpoints. What
// this takes is in the library, 2.9, but in none of its installed headers; with another version both do nothing.
#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>

namespace eciton::bus::fastdds {

/// Fast DDS tells a participant it discovers of its endpoints at once, and if that was too early, again after 1 s:
/// not configurable in 2.9. Cyclone DDS, which learns of Fast DDS by another thread than it hears that first message
/// with, often misses it, and knew none of our endpoints for 1.0 to 1.3 s (half of 19 mixed processes started
/// together). Here the second becomes 50 ms.
void hasten_discovery(const eprosima::fastdds::dds::DomainParticipant& participant);

/// Sends the participant's announcement now. Not by changing a QoS: 2.9 then announces, beside its own ports, those
/// of the first participant of the host, where Cyclone DDS from then on sends everything (it takes the fewest
/// addresses that cover all readers), so that the others hear nothing that is best effort.
void announce(const eprosima::fastdds::dds::DomainParticipant& participant);

}  // namespace eciton::bus::fastdds
