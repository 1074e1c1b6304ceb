// Section and number of the RTPS specification 2.3 (formal/2019-04-03) at each constant that comes from there.
#include "benchmarks/formation/rtps_meter.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace eciton::bench {
namespace {

using Bytes = std::span<const std::uint8_t>;

// 9.4.5.1.1: submessage kinds
constexpr std::uint8_t acknack = 0x06, heartbeat = 0x07, gap = 0x08, info_destination = 0x0e, nack_fragment = 0x12,
                       heartbeat_fragment = 0x13, data = 0x15, data_fragment = 0x16;
// 9.3.1.2: kinds of entities; the two upper bits of the last byte say whose they are
constexpr std::uint8_t builtin_bits = 0xc0;
// 9.3.1.5: entities that every participant has
constexpr std::uint32_t participant_writer = 0x000100c2, publications_writer = 0x000003c2,
                        liveliness_writer = 0x000200c2;
// 9.6.2.2.2: parameters
constexpr std::uint16_t sentinel = 0x0001, topic_name = 0x0005, endpoint_guid = 0x005a;

constexpr std::size_t ethernet_header = 14, udp_header = 8, message_header = 20, submessage_header = 4;

std::uint32_t number(Bytes bytes, std::size_t at, std::size_t size, bool little) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < size; ++k) {
    const std::size_t place = little ? size - 1 - k : k;
    value = value << 8 | bytes[at + place];
  }
  return value;
}

}  // namespace

/// One of a message, its entities where it names some.
struct RtpsMeter::Submessage {
  std::uint8_t kind = 0;
  bool little = true;
  Bytes body;
  Prefix source{};

  std::uint8_t flags = 0;
  /// Both entity ids come first, reader then writer; in data after four more bytes.
  std::optional<std::uint32_t> writer() const {
    const bool has_data = kind == data || kind == data_fragment;
    const bool named = has_data || kind == acknack || kind == heartbeat || kind == gap || kind == nack_fragment ||
                       kind == heartbeat_fragment;
    const std::size_t at = has_data ? 8 : 4;
    if (!named || body.size() < at + 4) return std::nullopt;
    return number(body, at, 4, false);
  }
  /// The acknowledging side names the other's writer.
  bool from_reader() const { return kind == acknack || kind == nack_fragment; }
};

TrafficCount RtpsMeter::discovery() const {
  TrafficCount sum;
  for (const RtpsUse use : {RtpsUse::participants, RtpsUse::endpoints, RtpsUse::liveliness, RtpsUse::unreachable}) {
    sum.packets += of(use).packets;
    sum.bytes += of(use).bytes;
  }
  return sum;
}

void RtpsMeter::restart() {
  uses_ = {};
  multicast_ = total_ = {};
  topics_.clear();
}

void RtpsMeter::add(Bytes frame, std::uint32_t size) {
  ++total_.packets;
  total_.bytes += size;
  if (!frame.empty() && (frame[0] & 1) != 0) {
    ++multicast_.packets;
    multicast_.bytes += size;
  }
  const auto other = [&] { count({.use = RtpsUse::other, .topic = nullptr, .bytes = size}, 1); };
  constexpr std::size_t ip_header_min = 20;
  if (frame.size() < ethernet_header + ip_header_min || number(frame, 12, 2, false) != 0x0800) return other();
  const Bytes ip = frame.subspan(ethernet_header);
  constexpr std::uint8_t icmp = 1, udp = 17, destination_unreachable = 3;
  const std::size_t ip_header = std::size_t{ip[0] & 0x0fu} * 4;
  const std::uint32_t fragment = number(ip, 6, 2, false);
  const std::uint32_t key = number(ip, 14, 2, false) << 16 | number(ip, 4, 2, false);
  if (ip[9] == icmp && ip.size() > ip_header && ip[ip_header] == destination_unreachable) {
    return count({.use = RtpsUse::unreachable, .topic = nullptr, .bytes = size}, 1);
  }
  if (ip[9] != udp) return other();
  if ((fragment & 0x1fff) != 0) {  // not the first: it is what the first one was
    const auto first = fragments_.find(key);
    return count({.use = first != fragments_.end() ? first->second : RtpsUse::other, .topic = nullptr, .bytes = size},
                 1);
  }
  if (ip.size() < ip_header + udp_header + message_header) return other();
  const Bytes message = ip.subspan(ip_header + udp_header);
  if (std::memcmp(message.data(), "RTPS", 4) != 0) return other();
  add_message(message, size);
  if ((fragment & 0x2000) != 0) {
    if (fragments_.size() > 1000) fragments_.clear();
    fragments_[key] = RtpsUse::endpoints;  // nothing else is that large
  }
}

void RtpsMeter::add_message(Bytes message, std::uint32_t size) {
  Prefix source{}, destination{};
  std::copy_n(message.begin() + 8, source.size(), source.begin());
  std::vector<Share> shares;
  std::uint32_t shared = 0;
  Bytes rest = message.subspan(message_header);
  while (rest.size() >= submessage_header) {
    Submessage s{.kind = rest[0], .little = (rest[1] & 1) != 0, .body = {}, .source = source, .flags = rest[1]};
    std::size_t length = number(rest, 2, 2, s.little);
    rest = rest.subspan(submessage_header);
    if (length == 0 || length > rest.size()) length = rest.size();  // zero: up to the end of the message
    s.body = rest.first(length);
    rest = rest.subspan(length);
    if (s.kind == info_destination && s.body.size() >= destination.size()) {
      std::copy_n(s.body.begin(), destination.size(), destination.begin());
    }
    if (!s.writer()) continue;
    learn_writer(s);
    shares.push_back(share_of(s, source, destination));
    shared += shares.back().bytes;
  }
  if (shares.empty()) return count({.use = RtpsUse::other, .topic = nullptr, .bytes = size}, 1);
  for (const Share& share : shares) count(share, static_cast<double>(size) / shared);
}

RtpsMeter::Share RtpsMeter::share_of(const Submessage& s, const Prefix& source, const Prefix& destination) const {
  const std::uint32_t writer = *s.writer();
  Share share{.use = RtpsUse::topics,
              .topic = nullptr,
              .bytes = static_cast<std::uint32_t>(s.body.size() + submessage_header)};
  if ((writer & builtin_bits) == builtin_bits) {
    share.use = writer == participant_writer  ? RtpsUse::participants
                : writer == liveliness_writer ? RtpsUse::liveliness
                                              : RtpsUse::endpoints;
    return share;
  }
  Guid guid{};
  const Prefix& owner = s.from_reader() ? destination : source;
  std::copy(owner.begin(), owner.end(), guid.begin());
  for (std::size_t k = 0; k < 4; ++k) guid[12 + k] = static_cast<std::uint8_t>(writer >> (24 - 8 * k));
  if (const auto known = writers_.find(guid); known != writers_.end()) share.topic = &known->second;
  return share;
}

/// An announced writer's parameters: its GUID and its topic.
void RtpsMeter::learn_writer(const Submessage& s) {
  if (s.kind != data || *s.writer() != publications_writer || s.body.size() < 20) return;
  std::size_t at = 4 + number(s.body, 2, 2, s.little);
  const bool inline_qos = (s.flags & 2) != 0;
  const auto skip_parameters = [&](bool little, const auto& visit) {
    while (at + 4 <= s.body.size()) {
      const std::uint32_t id = number(s.body, at, 2, little), length = number(s.body, at + 2, 2, little);
      at += 4;
      if (id == sentinel || at + length > s.body.size()) return;
      visit(id, s.body.subspan(at, length));
      at += length;
    }
  };
  if (inline_qos) skip_parameters(s.little, [](std::uint32_t, Bytes) {});
  if (at + 4 > s.body.size()) return;
  const bool little = s.body[at + 1] == 0x03;  // 10.2.1.2: PL_CDR_LE
  at += 4;
  Guid guid{};
  std::string topic;
  skip_parameters(little, [&](std::uint32_t id, Bytes value) {
    if (id == endpoint_guid && value.size() >= guid.size()) std::copy_n(value.begin(), guid.size(), guid.begin());
    if (id != topic_name || value.size() < 5) return;
    const std::size_t length = std::min<std::size_t>(number(value, 0, 4, little), value.size() - 4);
    topic.assign(reinterpret_cast<const char*>(value.data()) + 4, length);
    while (!topic.empty() && topic.back() == '\0') topic.pop_back();
  });
  if (!topic.empty()) writers_[guid] = topic;
}

void RtpsMeter::count(const Share& share, double scale) {
  const auto bytes = static_cast<std::uint64_t>(share.bytes * scale + 0.5);
  TrafficCount& use = uses_[static_cast<std::size_t>(share.use)];
  ++use.packets;
  use.bytes += bytes;
  if (share.use != RtpsUse::topics) return;
  TrafficCount& topic = topics_[share.topic != nullptr ? *share.topic : "?"];
  ++topic.packets;
  topic.bytes += bytes;
}

}  // namespace eciton::bench
