// The network interface and the peers of a participant, as addresses. Both vendors' plugins ask here, so
// that both give the same answer to the same wrong name.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.hpp"

namespace eciton::bus::vendors {

/// The first IPv4 address of an interface, dotted. An unknown name is an error that lists those that exist.
Result<std::string> interface_address(const std::string& name);

/// The IPv4 addresses of peers given as addresses or host names.
Result<std::vector<std::string>> peer_addresses(const char* const* peers, std::uint32_t count);

/// Participants of one host: how many a host has room for, and to how many ports of every peer an announcement goes.
/// Every port costs airtime for as long as the participant lives, open or not (measured with 16 modules: 464 kbit/s
/// per module at ten ports a second), so hosts announce themselves to the first participant of each peer, its radio.
/// Who starts beside a radio, as an operator's command, announces itself to the radios, and they answer.
struct UnicastRange {
  int participants = 10;
  int announced_to = 1;
};
/// On loopback packets are cheap and a whole fleet shares the host.
UnicastRange unicast_range(const std::vector<std::string>& peers);

/// How often a participant says that it is there, and for how long others believe it.
struct AnnouncementPace {
  std::uint32_t period_ms = 0;
  std::uint32_t lease_ms = 0;
};
/// Over multicast one packet is heard by all; to static peers every announcement is a packet for each. With 16
/// modules 30 s cost 2 to 4 kbit/s per module, 1 s ten times what everything else does; and a radio that was away for
/// some seconds need not be found again. On loopback, and without peers, as asked.
AnnouncementPace announcement_pace(std::uint32_t lease_ms, const std::vector<std::string>& peers);

/// Where the first participant of a host hears of others (9.6.1.1 of the RTPS specification).
int first_discovery_port(std::uint32_t domain);
/// The first such port that nobody holds, of as many as there is room for; the first of all when all are held.
int free_discovery_port(std::uint32_t domain);

}  // namespace eciton::bus::vendors
