// A directed pair of participants: its quality, its own random stream, and what becomes of a sample on it.
// Pure: depends on nothing but the stream, so that one seed always gives the same network.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/bus/vendors/sim_network/sim_network.hpp"

namespace eciton::bus::sim_network {

/// SplitMix64 (Steele, Lea, Flood 2014): the same bits everywhere, unlike the standard's distributions.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next();
  double uniform();  // in [0, 1), 53 bits
  bool chance(double probability) { return probability > 0 && uniform() < probability; }

 private:
  std::uint64_t state_;
};

/// The stream of a link depends on the seed and both names, not on the order of creation.
std::uint64_t link_seed(std::uint64_t seed, std::string_view from, std::string_view to);

/// What becomes of one sample. Delays count from the write.
struct Fate {
  bool lost = false;
  bool held_back = false;             // out of order, by `hold`
  std::uint32_t attempts = 1;         // reliable only
  Duration last_attempt{};            // when the attempt that arrives was made
  Duration delay{};                   // until it arrives
  std::optional<Duration> duplicate;  // until the second copy arrives
};

/// A reliable sample is given up after this many attempts: a bound, far beyond what chance reaches.
inline constexpr std::uint32_t attempts_max = 64;
/// Added to the round trip: the heartbeat after which a reader asks for what it misses.
inline constexpr Duration retransmission_period = 20ms;

Fate decide(const LinkQuality& quality, bool reliable, RandomStream& random);

struct Link {
  std::optional<LinkQuality> quality;  // else the network's default
  RandomStream random;
  Statistics statistics;
};

}  // namespace eciton::bus::sim_network
