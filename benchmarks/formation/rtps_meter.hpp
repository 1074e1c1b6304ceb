// What RTPS packets are for: finding participants, their endpoints, keeping them alive, or carrying topics. Pure:
// given packets as they leave an interface, counts their bytes.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace eciton::bench {

enum class RtpsUse : std::uint8_t {
  participants,
  endpoints,
  liveliness,
  unreachable,  // "nobody listens here": what an announcement to a port that is not open costs besides
  topics,
  other
};
inline constexpr std::array<const char*, 6> rtps_use_names{"participants", "endpoints", "liveliness",
                                                           "unreachable",  "topics",    "other"};

struct TrafficCount {
  std::uint64_t packets = 0;
  std::uint64_t bytes = 0;
};

class RtpsMeter {
 public:
  /// An Ethernet frame with all its headers; `size` as it was on the wire, `frame` may be cut short. Its bytes go to
  /// the uses of its submessages, by their sizes.
  void add(std::span<const std::uint8_t> frame, std::uint32_t size);

  const TrafficCount& of(RtpsUse use) const { return uses_[static_cast<std::size_t>(use)]; }
  /// All but topics and what is not RTPS.
  TrafficCount discovery() const;
  /// Of the topic's own data and acknowledgements; topics are known once their writers were announced.
  const std::map<std::string, TrafficCount>& topics() const { return topics_; }
  TrafficCount multicast() const { return multicast_; }
  TrafficCount total() const { return total_; }
  /// Counts anew; what was learned of writers stays.
  void restart();

 private:
  using Guid = std::array<std::uint8_t, 16>;
  using Prefix = std::array<std::uint8_t, 12>;
  struct Submessage;
  struct Share {
    RtpsUse use = RtpsUse::other;
    const std::string* topic = nullptr;
    std::uint32_t bytes = 0;
  };

  void add_message(std::span<const std::uint8_t> message, std::uint32_t size);
  Share share_of(const Submessage& submessage, const Prefix& source, const Prefix& destination) const;
  void learn_writer(const Submessage& submessage);
  void count(const Share& share, double scale);

  std::array<TrafficCount, rtps_use_names.size()> uses_{};
  TrafficCount multicast_, total_;
  std::map<std::string, TrafficCount> topics_;
  std::map<Guid, std::string> writers_;
  std::map<std::uint32_t, RtpsUse> fragments_;  // use of a datagram's first fragment, by sender and identification
};

}  // namespace eciton::bench
