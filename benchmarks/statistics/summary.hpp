// The figures of a distribution: exact order statistics, never a histogram's buckets, and the jitter from one
// value to the next.
#pragma once

#include <cstddef>
#include <vector>

#include "benchmarks/statistics/samples.hpp"

namespace eciton::bench {

/// Without values all are NaN. A quantile that the count does not resolve is the greatest value: ask resolves().
struct Summary {
  std::size_t count = 0;
  double mean = 0;
  double p50 = 0, p90 = 0, p99 = 0, p999 = 0, p9999 = 0;
  double max = 0;
  double jitter_mean = 0, jitter_p99 = 0;  // of |difference| to the value before
};

Summary summarize(const Samples& samples);

/// The value of rank ⌈fraction · n⌉, counted from 1; NaN without values. 0 gives the least, 1 the greatest.
double quantile(const std::vector<double>& values, double fraction);
double quantile_of_sorted(const std::vector<double>& sorted, double fraction);

/// Whether at least one value is expected above this quantile: p99.99 wants 10,000.
bool resolves(std::size_t count, double fraction);

/// |difference| of each value to the one before.
std::vector<double> jitter(const std::vector<double>& values);

}  // namespace eciton::bench
