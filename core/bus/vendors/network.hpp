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

/// Participants of one host that unicast discovery can tell apart: each announcement goes to this many ports of
/// every peer, so it is kept small; the swarm ring has one participant per host, and the odd operator command.
inline constexpr int kUnicastParticipantsPerHost = 10;
/// On loopback packets are cheap and a whole fleet shares the host.
inline constexpr int kUnicastParticipantsOnLoopback = 40;
int unicast_participants(const std::vector<std::string>& peers);

}  // namespace eciton::bus::vendors
