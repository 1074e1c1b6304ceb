// Looks interfaces up with getifaddrs and peers with getaddrinfo; only at start-up, never on a step path.
#include "core/bus/vendors/network.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

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

/// No peers at all count as such.
bool all_on_loopback(const std::vector<std::string>& peers) {
  return std::all_of(peers.begin(), peers.end(), [](const std::string& peer) { return peer.starts_with("127."); });
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

AnnouncementPace announcement_pace(std::uint32_t lease_ms, const std::vector<std::string>& peers) {
  constexpr std::uint32_t unicast_lease_ms = 90'000;
  const std::uint32_t lease = all_on_loopback(peers) ? lease_ms : std::max(lease_ms, unicast_lease_ms);
  return {.period_ms = lease / 3, .lease_ms = lease};
}

UnicastRange unicast_range(const std::vector<std::string>& peers) {
  return all_on_loopback(peers) ? UnicastRange{.participants = 40, .announced_to = 40} : UnicastRange{};
}

int first_discovery_port(std::uint32_t domain) { return 7400 + 250 * static_cast<int>(domain) + 10; }
int free_discovery_port(std::uint32_t domain) {
  const int first = first_discovery_port(domain);
  for (int port = first; port < first + 2 * UnicastRange{}.participants; port += 2) {
    const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    const bool free = bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    close(fd);
    if (free) return port;
  }
  return first;
}

}  // namespace eciton::bus::vendors
