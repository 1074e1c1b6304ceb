// What the air does to modules: gusts, the wakes of neighbours' rotors side by side, and the jets below
// rotors. Pure but for its random streams; forces in world axes.
#pragma once

#include <vector>

#include "core/robot/airframe.hpp"
#include "hal/sim/random.hpp"

namespace eciton::hal::sim {

/// The one constant of the side-by-side wakes: standard deviation per axis, N, of the force on a module
/// 1 m from one neighbour at hover thrust; it falls with the square of the distance. Calibrated once, so that the
/// paper's own law at N=3 shows the paper's 0.2-0.3 N of mean contact force (and its 0.05 Nm), then frozen:
/// docs/decisions/0013.
inline constexpr double wake_force_N_at_1m = 0.115;
inline constexpr double wake_time_s = 0.3;
inline constexpr double gust_time_s = 1.0;

/// Ornstein-Uhlenbeck process of unit variance per axis, exactly discretised, stationary from the start.
class UnitGust {
 public:
  explicit UnitGust(Random random) : random_(random), x_(random_.normal3()) {}
  const robot::Vector3& step(double dt_s, double time_s);

 private:
  Random random_;
  robot::Vector3 x_;
};

/// Air speed below a hovering rotor, m/s, `axial_m` down its axis and `radial_m` off it.
/// Momentum theory: v_i = sqrt(T / 2 rho A), the tube contracting to A/2 at 2 v_i; once its shear layer has
/// reached the middle (6.2 jet diameters) a turbulent round jet, u ~ 1/x, half-speed radius 0.086 x.
double jet_speed_m_s(double thrust_N, double axial_m, double radial_m);

/// A rotor as the source of a jet.
struct JetSource {
  robot::Vector3 p_WR_m;
  robot::Vector3 down_W;  // against the thrust
  double thrust_N;
};

/// Force of the jet on a small patch of a body at `p_W_m`, N: drag at its speed there, along the jet.
robot::Vector3 jet_force_N(const JetSource& source, const robot::Vector3& p_W_m);

/// Standard deviation per axis, N, of the wake force at `distance_m` from a neighbour that lifts
/// `thrust_share` of its hover thrust.
double wake_deviation_N(double distance_m, double thrust_share);

}  // namespace eciton::hal::sim
