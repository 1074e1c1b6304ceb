// Textbook forms; each is one pass or one sort.
#include "deploy/report/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace eciton::report {

double mean(std::span<const double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double standard_deviation(std::span<const double> values) {
  if (values.size() < 2) return 0;
  const double middle = mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double quantile_of_sorted(std::span<const double> sorted, double fraction) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], rank - std::floor(rank));
}

Box box_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  Box box{};
  box.lower_quartile = quantile_of_sorted(values, 0.25);
  box.median = quantile_of_sorted(values, 0.5);
  box.upper_quartile = quantile_of_sorted(values, 0.75);
  const double reach = 1.5 * (box.upper_quartile - box.lower_quartile);
  box.whisker_low = box.lower_quartile;
  box.whisker_high = box.upper_quartile;
  for (const double value : values) {
    if (value >= box.lower_quartile - reach) box.whisker_low = std::min(box.whisker_low, value);
    if (value <= box.upper_quartile + reach) box.whisker_high = std::max(box.whisker_high, value);
  }
  return box;
}

double kernel_width(std::span<const double> values) {
  const Box box = box_of({values.begin(), values.end()});
  const double deviation = standard_deviation(values);
  const double from_quartiles = (box.upper_quartile - box.lower_quartile) / 1.34;
  const double spread = from_quartiles > 0 ? std::min(deviation, from_quartiles) : deviation;
  const double width = 0.9 * spread * std::pow(static_cast<double>(values.size()), -0.2);
  if (width > 0) return width;
  return values.empty() || values.front() == 0 ? 1e-9 : 1e-3 * std::abs(values.front());  // all are equal
}

double kernel_density(std::span<const double> values, double width, double at) {
  double sum = 0;
  for (const double value : values) {
    const double z = (at - value) / width;
    sum += std::exp(-0.5 * z * z);
  }
  return sum / (static_cast<double>(values.size()) * width * std::sqrt(2 * std::numbers::pi));
}

std::vector<double> low_passed(std::span<const double> values, double period_s, double corner_Hz) {
  std::vector<double> out(values.begin(), values.end());
  if (out.empty() || !(period_s > 0) || corner_Hz * period_s >= 0.5) return out;
  // Bilinear transform, warped so that the corner stays where it is.
  const double k = std::tan(std::numbers::pi * corner_Hz * period_s);
  const double a0 = 1 + std::numbers::sqrt2 * k + k * k;
  const double b = k * k / a0, a1 = 2 * (k * k - 1) / a0, a2 = (1 - std::numbers::sqrt2 * k + k * k) / a0;
  double x1 = out.front(), x2 = x1, y1 = x1, y2 = x1;
  for (double& value : out) {
    const double x = value;
    value = b * (x + 2 * x1 + x2) - a1 * y1 - a2 * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = value;
  }
  return out;
}

std::vector<std::size_t> thinned(std::span<const double> x, std::span<const double> y, std::size_t columns) {
  std::vector<std::size_t> kept;
  if (y.size() <= 4 * columns) {
    kept.resize(y.size());
    std::iota(kept.begin(), kept.end(), 0u);
    return kept;
  }
  const double width = (x.back() - x.front()) / static_cast<double>(columns);
  for (std::size_t begin = 0, end = 0; begin < y.size(); begin = end) {
    const double column = std::floor((x[begin] - x.front()) / width);
    std::size_t least = begin, greatest = begin;
    for (end = begin + 1; end < y.size() && std::floor((x[end] - x.front()) / width) <= column; ++end) {
      if (y[end] < y[least]) least = end;
      if (y[end] > y[greatest]) greatest = end;
    }
    std::array<std::size_t, 4> four{begin, least, greatest, end - 1};
    std::sort(four.begin(), four.end());
    for (const std::size_t i : four) {
      if (kept.empty() || kept.back() != i) kept.push_back(i);
    }
  }
  return kept;
}

}  // namespace eciton::report
