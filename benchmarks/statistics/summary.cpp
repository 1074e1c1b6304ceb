// Sorts once, then reads the ranks.
#include "benchmarks/statistics/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace eciton::bench {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> sorted(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values;
}

double mean(const std::vector<double>& values) {
  return values.empty() ? nan
                        : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

double quantile_of_sorted(const std::vector<double>& sorted_values, double fraction) {
  if (sorted_values.empty()) return nan;
  const auto count = static_cast<double>(sorted_values.size());
  // 0.99 · 100 is a hair above 99 in binary: not rank 100.
  const double rank = std::clamp(std::ceil(fraction * count * (1 - 1e-12)), 1.0, count);
  return sorted_values[static_cast<std::size_t>(rank) - 1];
}

double quantile(const std::vector<double>& values, double fraction) {
  return quantile_of_sorted(sorted(values), fraction);
}

bool resolves(std::size_t count, double fraction) { return static_cast<double>(count) * (1 - fraction) >= 1 - 1e-9; }

std::vector<double> jitter(const std::vector<double>& values) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < values.size(); ++i) steps.push_back(std::abs(values[i] - values[i - 1]));
  return steps;
}

Summary summarize(const Samples& samples) {
  const std::vector<double> values = sorted(samples.values);
  const std::vector<double> steps = jitter(samples.values);
  const auto at = [&](double fraction) { return quantile_of_sorted(values, fraction); };
  return {.count = values.size(),
          .mean = mean(values),
          .p50 = at(0.5),
          .p90 = at(0.9),
          .p99 = at(0.99),
          .p999 = at(0.999),
          .p9999 = at(0.9999),
          .max = at(1),
          .jitter_mean = mean(steps),
          .jitter_p99 = quantile(steps, 0.99)};
}

}  // namespace eciton::bench
