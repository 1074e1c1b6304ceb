// Where the two ends of a lane stand: on this host, or each in a host of its own, joined by the radio emulator, which
// may disturb what it carries.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "deploy/net/net.hpp"

namespace eciton::bench {

struct LatencyOptions;

/// Network namespaces by their files; empty: this one.
struct Place {
  std::string ping_namespace, echo_namespace;
  std::string network_interface = "lo";
};

/// "loopback", "hosts" or "impaired"; the last two hold a net of their own unless the options name two hosts.
class Venue {
 public:
  static Result<Venue> open(const std::string& over, const LatencyOptions& options);
  const Place& place() const { return place_; }

 private:
  Place place_;
  std::optional<net::OwnedNet> net_;
};

/// Before anything starts: rights, the hosts that were named, and the interface in both.
Status check_venue(const std::string& over, const LatencyOptions& options);

}  // namespace eciton::bench
