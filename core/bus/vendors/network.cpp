// Looks interfaces up with getifaddrs and peers with getaddrinfo; only at start-up, never on a step path.
#include "core/bus/vendors/network.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <set>

namespace eciton::bus::vendors {
namespace {

std::string dotted(const sockaddr* address) {
  char text[INET_ADDRSTRLEN] = "";
  inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(address)->sin_addr, text, sizeof text);
  return text;
}

std::string joined(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

}  // namespace

Result<std::string> interface_address(const std::string& name) {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) {
    return Error{"network interfaces cannot be listed: " + std::string(std::strerror(errno))};
  }
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> list(first, freeifaddrs);
  std::set<std::string> with_address;
  bool exists = false;
  for (const ifaddrs* entry = first; entry != nullptr; entry = entry->ifa_next) {
    exists = exists || name == entry->ifa_name;
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    if (name == entry->ifa_name) return dotted(entry->ifa_addr);
    with_address.insert(entry->ifa_name);
  }
  return Error{"network interface \"" + name + "\" " + (exists ? "has no IPv4 address" : "does not exist") +
               "; with an IPv4 address there are: " + joined(with_address)};
}

Result<std::vector<std::string>> peer_addresses(const char* const* peers, std::uint32_t count) {
  std::vector<std::string> addresses;
  for (std::uint32_t k = 0; k < count; ++k) {
    addrinfo hints{};
    hints.ai_family = AF_INET;
    hints.ai_socktype = SOCK_DGRAM;
    addrinfo* found = nullptr;
    const int status = getaddrinfo(peers[k], nullptr, &hints, &found);
    if (status != 0) {
      return Error{"peer \"" + std::string(peers[k]) + "\" is no IPv4 address or known host name (" +
                   gai_strerror(status) + "); give it as 192.168.1.11"};
    }
    addresses.push_back(dotted(found->ai_addr));
    freeaddrinfo(found);
  }
  return addresses;
}

int unicast_participants(const std::vector<std::string>& peers) {
  const bool loopback =
      std::all_of(peers.begin(), peers.end(), [](const std::string& peer) { return peer.starts_with("127."); });
  return loopback ? kUnicastParticipantsOnLoopback : kUnicastParticipantsPerHost;
}

}  // namespace eciton::bus::vendors
