// What becomes of a sample on a link: loss, retransmission, delay, duplication and reordering, drawn in a
// fixed order from the link's own stream.
#include "core/bus/vendors/sim_network/link.hpp"

#include <algorithm>

namespace eciton::bus::sim_network {

std::uint64_t RandomStream::next() {
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double RandomStream::uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

std::uint64_t link_seed(std::uint64_t seed, std::string_view from, std::string_view to) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a over both names, a zero byte between them
  const auto mix = [&hash](unsigned char byte) { hash = (hash ^ byte) * 0x100000001b3u; };
  for (const char c : from) mix(static_cast<unsigned char>(c));
  mix(0);
  for (const char c : to) mix(static_cast<unsigned char>(c));
  return RandomStream(seed).next() ^ RandomStream(hash).next();
}

namespace {

Duration draw_delay(const LinkQuality& quality, RandomStream& random) {
  if (quality.jitter <= Duration::zero()) return std::max(quality.delay, Duration::zero());
  const double offset = (2 * random.uniform() - 1) * static_cast<double>(quality.jitter.count());
  return std::max(quality.delay + Duration{static_cast<Duration::rep>(offset)}, Duration::zero());
}

}  // namespace

Fate decide(const LinkQuality& quality, bool reliable, RandomStream& random) {
  Fate fate;
  fate.lost = random.chance(quality.loss);
  while (reliable && fate.lost && fate.attempts < attempts_max) {
    ++fate.attempts;
    fate.last_attempt += 2 * (quality.delay + quality.jitter) + retransmission_period;
    fate.lost = random.chance(quality.loss);
  }
  if (fate.lost) return fate;
  fate.delay = fate.last_attempt + draw_delay(quality, random);
  if (!reliable && random.chance(quality.reordering)) {
    fate.held_back = true;
    fate.delay += quality.hold;
  }
  if (random.chance(quality.duplication)) fate.duplicate = fate.delay + draw_delay(quality, random);
  return fate;
}

}  // namespace eciton::bus::sim_network
