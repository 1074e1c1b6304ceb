// The blocks are sorted once; a quantile of a resample is then found by bisection over all values, without
// pooling them anew.
#include "benchmarks/statistics/bootstrap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "benchmarks/statistics/summary.hpp"

namespace eciton::bench {
namespace {

constexpr std::size_t resamples = 4000;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Quantiles of any multiset of the blocks: how often each block is taken.
class Pool {
 public:
  explicit Pool(Blocks blocks) : blocks_(std::move(blocks)) {
    for (std::vector<double>& block : blocks_) {
      std::sort(block.begin(), block.end());
      all_.insert(all_.end(), block.begin(), block.end());
    }
    std::sort(all_.begin(), all_.end());
  }

  double quantile(const std::vector<std::size_t>& times_taken, double fraction) const {
    std::size_t count = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) count += times_taken[b] * blocks_[b].size();
    if (count == 0) return nan;
    const auto size = static_cast<double>(count);
    const auto rank = static_cast<std::size_t>(std::clamp(std::ceil(fraction * size * (1 - 1e-12)), 1.0, size));
    return *std::partition_point(all_.begin(), all_.end(),
                                 [&](double value) { return at_most(value, times_taken) < rank; });
  }

 private:
  std::size_t at_most(double value, const std::vector<std::size_t>& times_taken) const {
    std::size_t count = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (times_taken[b] == 0) continue;
      const auto end = std::upper_bound(blocks_[b].begin(), blocks_[b].end(), value);
      count += times_taken[b] * static_cast<std::size_t>(end - blocks_[b].begin());
    }
    return count;
  }

  Blocks blocks_;
  std::vector<double> all_;
};

/// Not std::uniform_int_distribution, whose bits are the library's choice.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  void draw(std::vector<std::size_t>& times_taken) {
    std::fill(times_taken.begin(), times_taken.end(), 0);
    for (std::size_t i = 0; i < times_taken.size(); ++i) ++times_taken[(random_() >> 32) * times_taken.size() >> 32];
  }

 private:
  std::mt19937_64 random_;
};

/// 97.5 % quantile of Student's t.
double t_quantile(std::size_t freedom) {
  constexpr std::array<double, 15> table{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                                         2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131};
  if (freedom <= table.size()) return table[freedom - 1];
  const auto f = static_cast<double>(freedom);
  return 1.959964 + 2.372271 / f + 2.822499 / (f * f);  // Cornish-Fisher, to 0.0005 here
}

/// The plain percentiles of a bootstrap over few blocks are too narrow, as a standard deviation over n is:
/// Hesterberg's expanded percentiles, Φ(-√(n/(n-1)) t), make up for it.
double tail(std::size_t blocks) {
  const auto n = static_cast<double>(blocks);
  return 0.5 * std::erfc(std::sqrt(n / (n - 1)) * t_quantile(blocks - 1) / std::sqrt(2.0));
}

Interval interval_of(double value, std::vector<double>& drawn, std::size_t blocks) {
  std::erase_if(drawn, [](double x) { return std::isnan(x); });
  if (blocks < 2 || drawn.empty()) return {-infinity, value, infinity};
  std::sort(drawn.begin(), drawn.end());
  const double outside = tail(blocks);
  return {quantile_of_sorted(drawn, outside), value, quantile_of_sorted(drawn, 1 - outside)};
}

void drop_empty(Blocks& blocks) {
  std::erase_if(blocks, [](const std::vector<double>& block) { return block.empty(); });
}

}  // namespace

Interval median_interval(const Blocks& given, std::uint64_t seed) {
  Blocks blocks = given;
  drop_empty(blocks);
  if (blocks.empty()) return {nan, nan, nan};
  const Pool pool(blocks);
  std::vector<std::size_t> times(blocks.size(), 1);
  const double value = pool.quantile(times, 0.5);
  Draw draw(seed);
  std::vector<double> drawn;
  for (std::size_t i = 0; i < resamples && blocks.size() > 1; ++i) {
    draw.draw(times);
    drawn.push_back(pool.quantile(times, 0.5));
  }
  return interval_of(value, drawn, blocks.size());
}

Interval ratio_interval(const Blocks& blocks, const Blocks& baseline_blocks, double fraction, std::uint64_t seed) {
  const bool paired = blocks.size() == baseline_blocks.size();
  Blocks above = blocks, below = baseline_blocks;
  if (paired) {  // half a pair says nothing
    for (std::size_t i = 0; i < above.size(); ++i) {
      if (above[i].empty() || below[i].empty()) above[i].clear(), below[i].clear();
    }
  }
  drop_empty(above);
  drop_empty(below);
  if (above.empty() || below.empty()) return {nan, nan, nan};
  const Pool pool(above), baseline(below);
  std::vector<std::size_t> times(above.size(), 1), baseline_times(below.size(), 1);
  const auto ratio = [&] { return pool.quantile(times, fraction) / baseline.quantile(baseline_times, fraction); };
  const double value = ratio();
  Draw draw(seed);
  std::vector<double> drawn;
  for (std::size_t i = 0; i < resamples && std::min(above.size(), below.size()) > 1; ++i) {
    draw.draw(times);
    if (paired) {
      baseline_times = times;
    } else {
      draw.draw(baseline_times);
    }
    drawn.push_back(ratio());
  }
  return interval_of(value, drawn, std::min(above.size(), below.size()));
}

Blocks cut(const std::vector<double>& values, std::size_t count) {
  count = std::min(count, values.size());
  Blocks blocks;
  for (std::size_t b = 0; b < count; ++b) {
    const auto from = static_cast<std::ptrdiff_t>(b * values.size() / count);
    const auto to = static_cast<std::ptrdiff_t>((b + 1) * values.size() / count);
    blocks.emplace_back(values.begin() + from, values.begin() + to);
  }
  return blocks;
}

std::vector<std::size_t> abba_order(std::size_t variants, std::size_t rounds) {
  std::vector<std::size_t> order;
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < variants; ++i) order.push_back(round % 2 == 0 ? i : variants - 1 - i);
  }
  return order;
}

}  // namespace eciton::bench
