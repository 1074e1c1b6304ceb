// How much of the radio's medium a module uses: what it sent within a sliding window, headers included, as a
// share of what it may.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/time.hpp"

namespace eciton::radio {

struct AirtimeConfig {
  double budget_bit_s = 6e6;
  std::uint32_t overhead_bytes = 0;  // on the air, for each sample
  Duration window = 1s;
};

/// Real-time safe. The window moves on by tenths.
class Airtime {
 public:
  explicit Airtime(const AirtimeConfig& config) : config_(config) {}

  void add(TimePoint now, std::size_t payload_bytes);
  /// 0: idle, 1: the budget is used up, above: it is exceeded.
  double share(TimePoint now);

 private:
  static constexpr std::int64_t slots = 10;
  void advance(TimePoint now);

  AirtimeConfig config_;
  std::array<std::uint64_t, slots> bytes_{};
  std::int64_t slot_ = 0;  // counted from the epoch
};

}  // namespace eciton::radio
