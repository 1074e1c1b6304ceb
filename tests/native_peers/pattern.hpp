// The values that the framework and the vendors' own peers put into samples, from a seed, field by field in the
// order of the IDL: whoever draws the same values and gets the same bytes agrees on the layout.
#pragma once

#include <cstdint>
#include <string_view>

namespace eciton::native_peers {

/// Seeds a peer works with: 0 has everything at its greatest length, 1 everything empty.
inline constexpr std::uint64_t kSeeds = 4;

/// Draws differently for every topic and seed.
class Pattern {
 public:
  Pattern(std::string_view topic, std::uint64_t seed) : seed_(seed), state_(seed) {
    for (const char character : topic) state_ = state_ * 1099511628211u + static_cast<unsigned char>(character);
  }

  std::uint64_t number() {  // splitmix64
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// Of either sign, with a fraction, exact in binary.
  double real() { return static_cast<double>(static_cast<std::int64_t>(number()) >> 12) / 65536.0; }
  /// Small enough that a stamp is a plausible time.
  std::int64_t stamp() { return static_cast<std::int64_t>(number() >> 3); }
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(number() % count); }
  std::uint32_t length(std::uint32_t bound) {
    const std::uint32_t drawn = below(bound + 1);
    return seed_ == 0 ? bound : seed_ == 1 ? 0 : drawn;
  }
  char character() { return static_cast<char>('!' + below(94)); }

 private:
  std::uint64_t seed_;
  std::uint64_t state_;
};

}  // namespace eciton::native_peers
