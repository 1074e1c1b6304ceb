// At most one sample an interval for each key: what comes sooner is dropped and counted.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/bounded.hpp"
#include "core/base/time.hpp"

namespace eciton::radio {

/// Real-time safe. Bounded: when more than `keys_max` keys are in use, the one unused for longest is forgotten.
class RateLimit {
 public:
  static constexpr std::size_t keys_max = 32;

  /// An interval of zero lets everything pass.
  explicit RateLimit(Duration interval) : interval_(interval) {}

  bool allow(TimePoint now, std::uint64_t key);
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Entry {
    std::uint64_t key = 0;
    TimePoint due{};
  };
  Entry& entry_of(std::uint64_t key, TimePoint now);

  Duration interval_;
  BoundedVector<Entry, keys_max> entries_;
  std::uint64_t dropped_ = 0;
};

}  // namespace eciton::radio
