// What a plot shows of many values: means, quartiles, densities, filtered lines.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace eciton::report {

/// NaN without values.
double mean(std::span<const double> values);
/// About the mean, of the values themselves (divided by n); 0 of fewer than two.
double standard_deviation(std::span<const double> values);

/// Between the two nearest ranks, linearly: 0.5 of {1, 2, 3, 4} is 2.5. NaN without values.
double quantile_of_sorted(std::span<const double> sorted, double fraction);

/// A box plot's five numbers: whiskers end at the furthest values within 1.5 times the quartiles' distance.
struct Box {
  double whisker_low, lower_quartile, median, upper_quartile, whisker_high;
};
Box box_of(std::vector<double> values);

/// Silverman's rule: 0.9 min(standard deviation, quartiles' distance / 1.34) n^(-1/5); never 0.
double kernel_width(std::span<const double> values);
/// Density at `at`: the mean of Gaussians of that width about the values.
double kernel_density(std::span<const double> values, double width, double at);

/// Second-order Butterworth, as if the first value had stood for ever; unchanged where the samples cannot hold the
/// corner. The gain at the corner is 1/sqrt(2).
std::vector<double> low_passed(std::span<const double> values, double period_s, double corner_Hz);

/// Of at most so many columns along x the first, least, greatest and last value each: it looks the same.
/// `x` ascends. Fewer points are left as they are.
std::vector<std::size_t> thinned(std::span<const double> x, std::span<const double> y, std::size_t columns);

}  // namespace eciton::report
