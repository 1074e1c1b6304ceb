// Ticks at 1, 2 and 5 times the powers of ten.
#include "deploy/report/axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "deploy/report/text.hpp"

namespace eciton::report {
namespace {

/// Without the zeros that a measured figure would keep.
std::string label(double value) {
  if (std::abs(value) >= 1000 && std::abs(value) < 1e9) return number_text(value);
  char digits[32];
  std::snprintf(digits, sizeof(digits), "%.6g", value);
  return digits;
}

double round_step(double about) {
  const double decade = std::pow(10, std::floor(std::log10(about)));
  for (const double step : {1., 2., 5.}) {
    if (about <= step * decade * (1 + 1e-9)) return step * decade;
  }
  return 10 * decade;
}

}  // namespace

Axis Axis::around(double least, double greatest) {
  if (!(least > 0 && greatest / least > 20)) return least < 0 ? exactly(least, greatest) : from_zero(greatest);
  return of_logarithms(least, greatest);
}

Axis Axis::of_logarithms(double least, double greatest) {
  Axis axis;
  axis.logarithmic_ = true;
  axis.least_ = least / 1.1;
  axis.greatest_ = greatest * 1.1;
  return axis;
}

Axis Axis::from_zero(double greatest) { return exactly(0, greatest > 0 ? 1.05 * greatest : 1); }

Axis Axis::exactly(double least, double greatest) {
  Axis axis;
  axis.least_ = least;
  axis.greatest_ = greatest > least ? greatest : least + 1;
  return axis;
}

Axis Axis::with_room(double least, double greatest) {
  least = std::min(least, 0.0);
  greatest = std::max(greatest, 0.0);
  const double room = greatest > least ? 0.05 * (greatest - least) : 1;
  return exactly(least < 0 ? least - room : 0, greatest > 0 || least == 0 ? greatest + room : 0);
}

double Axis::position(double value) const {
  if (logarithmic_) {
    if (!(value > 0)) return 0;
    return std::clamp(std::log(value / least_) / std::log(greatest_ / least_), 0.0, 1.0);
  }
  return std::clamp((value - least_) / (greatest_ - least_), 0.0, 1.0);
}

std::vector<Tick> Axis::ticks() const {
  std::vector<Tick> out;
  const auto add = [&](double value) {
    if (value >= least_ - 1e-12 && value <= greatest_) out.push_back({value, label(value)});
  };
  if (!logarithmic_) {
    const double step = round_step((greatest_ - least_) / 6);
    for (double i = std::ceil(least_ / step); i * step <= greatest_; ++i)
      add(i == 0 ? 0 : i * step);  // no negative zero
    return out;
  }
  const bool crowded = std::log10(greatest_ / least_) > 3;
  for (double decade = std::pow(10, std::floor(std::log10(least_))); decade <= greatest_; decade *= 10) {
    add(decade);
    if (crowded) continue;
    add(2 * decade);
    add(5 * decade);
  }
  return out;
}

}  // namespace eciton::report
