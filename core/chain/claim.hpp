// A link claim: one module's word about one of its ports. The claiming module is its only writer.
// A module claims when its latch reports latched, withdraws when it reports open, and at no other time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>

namespace eciton::chain {

inline constexpr std::size_t max_modules = 16;  // in one structure
inline constexpr std::size_t max_ports = 4;     // of one module
inline constexpr std::size_t max_links = max_modules * max_ports / 2;

enum class LatchStatus : std::uint8_t { open, ready, latched };

struct Claim {
  std::uint32_t module = 0;
  std::uint32_t port = 0;
  std::uint32_t peer = 0;
  std::uint32_t peer_port = 0;
  bool withdrawn = true;  // not linked: peer and peer_port are void
  LatchStatus latch = LatchStatus::open;
  std::uint64_t incarnation = 0;      // of the module, larger after every restart
  std::uint64_t sequence_number = 0;  // grows with every change within one incarnation

  bool operator==(const Claim&) const = default;

  /// Whether this end says it is linked.
  bool holds() const { return !withdrawn && latch == LatchStatus::latched; }
  bool names(std::uint32_t other, std::uint32_t other_port) const {
    return holds() && peer == other && peer_port == other_port;
  }

  auto key() const { return std::tuple(module, port); }
  auto version() const { return std::tuple(incarnation, sequence_number); }
  /// Only decides between two claims of one version, which a single writer never makes: any fixed order
  /// does, as long as all modules use the same one.
  auto content() const { return std::tuple(withdrawn, latch, peer, peer_port); }
};

}  // namespace eciton::chain
