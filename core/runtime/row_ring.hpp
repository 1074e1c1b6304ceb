// The last rows of numbers, each with its stamp: what a service knew and did in its last steps. Pure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/base/time.hpp"

namespace eciton::runtime {

/// Bounded, and allocated at once. Real-time safe but for its making; one thread.
class RowRing {
 public:
  /// Both over zero.
  RowRing(std::size_t columns, std::size_t rows) : columns_(columns), stamps_(rows), values_(columns * rows) {}

  /// A new row to be filled in, of NaN until then; when all rows are taken the oldest gives way.
  std::span<double> push(TimePoint stamp) noexcept {
    const std::size_t place = (first_ + size_) % stamps_.size();
    if (size_ == stamps_.size()) {
      first_ = (first_ + 1) % stamps_.size();
    } else {
      ++size_;
    }
    stamps_[place] = stamp;
    const std::span row = std::span(values_).subspan(place * columns_, columns_);
    std::fill(row.begin(), row.end(), std::numeric_limits<double>::quiet_NaN());
    return row;
  }

  std::size_t size() const noexcept { return size_; }
  std::size_t bound() const noexcept { return stamps_.size(); }
  std::size_t columns() const noexcept { return columns_; }
  /// The oldest is number 0.
  TimePoint stamp(std::size_t k) const noexcept { return stamps_[place_of(k)]; }
  std::span<const double> row(std::size_t k) const noexcept {
    return std::span(values_).subspan(place_of(k) * columns_, columns_);
  }

  /// Takes over what another ring of the same columns and bound holds.
  void copy(const RowRing& other) noexcept {
    std::copy(other.stamps_.begin(), other.stamps_.end(), stamps_.begin());
    std::copy(other.values_.begin(), other.values_.end(), values_.begin());
    first_ = other.first_;
    size_ = other.size_;
  }

 private:
  std::size_t place_of(std::size_t k) const noexcept { return (first_ + k) % stamps_.size(); }

  std::size_t columns_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::vector<TimePoint> stamps_;
  std::vector<double> values_;
};

}  // namespace eciton::runtime
