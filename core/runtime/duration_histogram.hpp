// Durations counted in bins of equal ratio: quantiles within 3.2 % over any number of samples, in fixed
// memory. Integers only, so that the same samples give the same bits.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/time.hpp"

namespace eciton::runtime {

template <class Count>
class DurationHistogram {
 public:
  /// 16 bins to an octave up to 2^36 ns = 69 s; what is longer counts in the last bin. Real-time safe.
  static constexpr std::size_t bins = 16 + (36 - 4) * 16;

  void add(Duration d) noexcept {
    const std::size_t bin = bin_of(d);
    if (counts_[bin] < std::numeric_limits<Count>::max()) ++counts_[bin];
    low_ = std::min(low_, bin);
    high_ = std::max(high_, bin + 1);
  }
  void clear() noexcept {
    for (std::size_t k = low_; k < high_; ++k) counts_[k] = 0;
    low_ = bins;
    high_ = 0;
  }

  template <class Other>
  void add(const DurationHistogram<Other>& other) noexcept {
    for (std::size_t k = other.low_; k < other.high_; ++k) counts_[k] += other.counts_[k];
    low_ = std::min(low_, other.low_);
    high_ = std::max(high_, other.high_);
  }

  std::uint64_t total() const {
    std::uint64_t sum = 0;
    for (std::size_t k = low_; k < high_; ++k) sum += counts_[k];
    return sum;
  }

  /// The middle of the bin that holds the sample of rank ⌈fraction · total⌉; zero without samples.
  Duration quantile(double fraction) const {
    const std::uint64_t count = total();
    const auto rank =
        std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(count))));
    std::uint64_t seen = 0;
    for (std::size_t k = low_; k < high_; ++k) {
      seen += counts_[k];
      if (seen >= rank) return middle_of(k);
    }
    return Duration::zero();
  }

 private:
  static constexpr std::size_t bin_of(Duration d) {
    const auto ns = static_cast<std::uint64_t>(std::max<Duration::rep>(d.count(), 0));
    if (ns < 16) return ns;
    const auto exponent = static_cast<std::size_t>(std::bit_width(ns)) - 1;
    return std::min(bins - 1, 16 + (exponent - 4) * 16 + ((ns >> (exponent - 4)) & 15));
  }
  static constexpr Duration middle_of(std::size_t bin) {
    if (bin < 16) return Duration{static_cast<std::int64_t>(bin)};
    const std::size_t octave = (bin - 16) / 16;
    const std::int64_t low = static_cast<std::int64_t>(16 + (bin - 16) % 16) << octave;
    return Duration{low + ((std::int64_t{1} << octave) >> 1)};
  }

  template <class Other>
  friend class DurationHistogram;

  std::array<Count, bins> counts_{};
  // Where samples lie: a heartbeat looks at ten of these.
  std::size_t low_ = bins;
  std::size_t high_ = 0;
};

}  // namespace eciton::runtime
