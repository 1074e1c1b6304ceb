// From thrust to what a speed controller is told and back, at the battery's voltage: the airframe's measured
// polynomials, nearest reference voltage, scaled by (V / V_ref)^2. Pure; cheap enough for 1 kHz.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/robot/airframe.hpp"

namespace eciton::robot {

/// Measured at one voltage: thrust = p0 + (p1 x + p2 x^2) / 10, N; x is the pulse width in percent.
struct ThrustCurve {
  double voltage_V = 0;
  double p2 = 0, p1 = 0, p0 = 0;
};

struct ThrustMap {
  std::array<ThrustCurve, 4> curves{};
  std::size_t curve_count = 0;  // 0: thrust in proportion to the throttle, at any voltage
  double thrust_N_min = 2;      // below it the curves are not used: nobody measured there
  double percent_min = 50;      // motors stand still
  double percent_max = 98;      // never more
  double thrust_N_full = 0;     // without curves: at 100 %

  /// 50 % and less: 0. From there a straight line up to thrust_N_min, whatever the rotor really does there; then the
  /// curve. Rises with `percent` up to percent_max, and stays.
  double thrust_N(double percent, double battery_V) const;
  /// 0 and less, or no number: percent_min, the motor stands still. Else at least thrust_N_min, at most percent_max.
  double percent(double thrust_N, double battery_V) const;

 private:
  const ThrustCurve& nearest(double battery_V) const;
  double percent_on_curve(double thrust_N, double battery_V) const;
};

/// The map of the rotors of an airframe that comes with Eciton; of any other, in proportion up to its greatest
/// thrust.
ThrustMap thrust_map(const Airframe& airframe);

/// DShot's throttle, 48 to 2047; 0 (stop) at 50 % and less.
std::uint16_t dshot_value(double percent);

}  // namespace eciton::robot
