// Random numbers of the simulated world: one stream per seed, module id and purpose, so that one more
// module or sensor shifts no other's noise. Same bits on every standard library (xoshiro256**).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/robot/frames.hpp"

namespace eciton::hal::sim {

enum class Purpose : std::uint64_t {
  mismatch = 1,
  imu,
  pose,
  drift,
  readings,
  gust,
  wake,
  imu_fault,
  pose_fault,
  battery
};

class Random {
 public:
  Random(std::uint64_t seed, std::uint32_t module_id, Purpose purpose) {
    std::uint64_t x = seed;
    x = split_mix(x) ^ module_id;
    x = split_mix(x) ^ static_cast<std::uint64_t>(purpose);
    for (std::uint64_t& word : state_) word = split_mix(x);
  }

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double min, double max) { return min + (max - min) * uniform(); }

  /// Standard normal (Box-Muller, both halves used).
  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    const double angle = 2.0 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }
  robot::Vector3 normal3() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }
  robot::Vector3 uniform3(double min, double max) {
    const double x = uniform(min, max), y = uniform(min, max), z = uniform(min, max);
    return {x, y, z};
  }

 private:
  static std::uint64_t split_mix(std::uint64_t& x) {
    std::uint64_t z = (x += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  std::uint64_t next() {
    const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  std::uint64_t state_[4];
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace eciton::hal::sim
