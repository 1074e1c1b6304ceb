// Gusts, wakes and jets.
#include "hal/sim/disturbances.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eciton::hal::sim {
namespace {

constexpr double air_kg_m3 = 1.225;
constexpr double rotor_radius_m = 0.0635;  // 5 inch propellers
/// Drag area of one patch seen by a jet: a rotor's housing and its share of the frame, 0.1 m x 0.06 m, Cd 1.
constexpr double patch_drag_area_m2 = 0.006;
constexpr double core_length_diameters = 6.2;
constexpr double half_speed_slope = 0.086;
/// Closer than this two modules' rotors would overlap; keeps 1/d^2 bounded.
constexpr double wake_distance_m_min = 0.5;

}  // namespace

const robot::Vector3& UnitGust::step(double dt_s, double time_s) {
  const double kept = std::exp(-dt_s / time_s);
  x_ = kept * x_ + std::sqrt(1 - kept * kept) * random_.normal3();
  return x_;
}

double jet_speed_m_s(double thrust_N, double axial_m, double radial_m) {
  if (axial_m <= 0 || thrust_N <= 0) return 0;
  const double disc_m2 = std::numbers::pi * rotor_radius_m * rotor_radius_m;
  const double induced_m_s = std::sqrt(thrust_N / (2 * air_kg_m3 * disc_m2));
  const double growth = 1 + axial_m / std::hypot(axial_m, rotor_radius_m);  // 1 at the disc, 2 far below
  const double tube_radius_m = rotor_radius_m / std::sqrt(growth);
  const double core_m = core_length_diameters * 2 * rotor_radius_m / std::numbers::sqrt2;
  const double middle_m_s = induced_m_s * growth * std::min(1.0, core_m / axial_m);
  const double half_radius_m = std::max(tube_radius_m, half_speed_slope * axial_m);
  const double ratio = radial_m / half_radius_m;
  return middle_m_s * std::exp2(-ratio * ratio);
}

robot::Vector3 jet_force_N(const JetSource& source, const robot::Vector3& p_W_m) {
  const robot::Vector3 offset = p_W_m - source.p_WR_m;
  const double axial_m = offset.dot(source.down_W);
  if (axial_m <= 0) return robot::Vector3::Zero();
  const double radial_m = (offset - axial_m * source.down_W).norm();
  if (radial_m > 3 * rotor_radius_m + 0.3 * axial_m) return robot::Vector3::Zero();  // below 1e-3 of the middle
  const double u = jet_speed_m_s(source.thrust_N, axial_m, radial_m);
  return 0.5 * air_kg_m3 * patch_drag_area_m2 * u * u * source.down_W;
}

double wake_deviation_N(double distance_m, double thrust_share) {
  const double d = std::max(distance_m, wake_distance_m_min);
  return wake_force_N_at_1m * thrust_share / (d * d);
}

}  // namespace eciton::hal::sim
