// A series of measured values: exact mean, standard deviation and extremes over all of them, quantiles over
// the last of them that fit in bounded memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace eciton::deploy {

class MeasuredSeries {
 public:
  explicit MeasuredSeries(std::size_t kept_max = 200'000) : kept_max_(kept_max) {}

  void add(double value) {
    ++count_;
    const double step = value - mean_;  // Welford
    mean_ += step / static_cast<double>(count_);
    square_sum_ += step * (value - mean_);
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
    if (kept_.size() < kept_max_) {
      kept_.push_back(value);
    } else {
      kept_[(count_ - 1) % kept_max_] = value;
    }
  }
  void clear() { *this = MeasuredSeries(kept_max_); }

  std::uint64_t count() const { return count_; }
  /// Undefined without values, as are the others.
  double mean() const { return mean_; }
  double min() const { return min_; }
  double max() const { return max_; }
  double standard_deviation() const {
    return count_ > 1 ? std::sqrt(square_sum_ / static_cast<double>(count_ - 1)) : 0;
  }
  /// Of rank ⌈fraction · n⌉.
  double quantile(double fraction) const {
    std::vector<double> sorted = kept_;
    const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(sorted.size())));
    const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
    std::nth_element(sorted.begin(), at, sorted.end());
    return *at;
  }

 private:
  std::size_t kept_max_;
  std::uint64_t count_ = 0;
  double mean_ = 0;
  double square_sum_ = 0;
  double min_ = std::numeric_limits<double>::infinity();
  double max_ = -std::numeric_limits<double>::infinity();
  std::vector<double> kept_;
};

}  // namespace eciton::deploy
