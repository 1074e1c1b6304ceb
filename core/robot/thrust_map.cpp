// The thrust map both ways.
#include "core/robot/thrust_map.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::robot {
namespace {

/// 5055S-3 on six cells, from the authors' public robot description.
constexpr std::array<ThrustCurve, 4> legion_curves{{{25.2, .049571, -1.694028, -6.361408},
                                                    {24.2, .053369, -2.573162, -2.506118},
                                                    {23.2, .048899, -2.190795, -3.402775},
                                                    {22.2, .038181, -1.049692, -6.471275}}};

double scale(const ThrustCurve& curve, double battery_V) {
  const double ratio = battery_V / curve.voltage_V;
  return ratio * ratio;
}

}  // namespace

const ThrustCurve& ThrustMap::nearest(double battery_V) const {
  const auto off = [battery_V](const ThrustCurve& c) { return std::abs(c.voltage_V - battery_V); };
  return *std::min_element(curves.begin(), curves.begin() + static_cast<std::ptrdiff_t>(curve_count),
                           [&](const ThrustCurve& a, const ThrustCurve& b) { return off(a) < off(b); });
}

double ThrustMap::percent_on_curve(double thrust_N, double battery_V) const {
  const ThrustCurve& c = nearest(battery_V);
  // The greater root: thrust rises there.
  const double under_root = c.p1 * c.p1 + 40 * c.p2 * (thrust_N / scale(c, battery_V) - c.p0);
  return (-c.p1 + std::sqrt(std::max(under_root, 0.0))) / (2 * c.p2);
}

double ThrustMap::thrust_N(double percent, double battery_V) const {
  if (!(percent > percent_min) || !(battery_V > 0)) return 0;
  const double x = std::min(percent, percent_max);
  if (curve_count == 0) return thrust_N_full * (x - percent_min) / (100 - percent_min);
  const ThrustCurve& c = nearest(battery_V);
  const double on_curve_N = scale(c, battery_V) * (c.p0 + 0.1 * x * (c.p1 + c.p2 * x));
  if (on_curve_N >= thrust_N_min) return on_curve_N;
  const double lowest = percent_on_curve(thrust_N_min, battery_V);
  return thrust_N_min * (x - percent_min) / (lowest - percent_min);
}

double ThrustMap::percent(double thrust_N, double battery_V) const {
  if (!(thrust_N > 0) || !(battery_V > 0)) return percent_min;
  if (curve_count == 0) {
    return std::min(percent_min + (100 - percent_min) * thrust_N / thrust_N_full, percent_max);
  }
  return std::clamp(percent_on_curve(std::max(thrust_N, thrust_N_min), battery_V), percent_min, percent_max);
}

ThrustMap thrust_map(const Airframe& airframe) {
  ThrustMap map;
  for (const RotorGeometry& rotor : airframe.rotors)
    map.thrust_N_full = std::max(map.thrust_N_full, rotor.thrust_N_max);
  if (airframe.name == "legion" || airframe.name == "legion-lidar") {
    map.curves = legion_curves;
    map.curve_count = legion_curves.size();
  }
  return map;
}

std::uint16_t dshot_value(double percent) {
  if (!(percent > 50)) return 0;
  const double value = (percent / 100 - 0.5) / 0.5 * 1999 + 48;
  return static_cast<std::uint16_t>(std::lround(std::min(value, 2047.0)));
}

}  // namespace eciton::robot
