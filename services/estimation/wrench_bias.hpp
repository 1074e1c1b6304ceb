// What the wrench observer reads in free hover, explained by what is false in the airframe's model: rotors that push
// harder or softer than they should, mass, centre of mass, and the attitude that the pose sensor gives. Each turns
// with the module in its own way, so the zero still holds once the chain has bent, where a constant one does not.
//
// To first order, in hover, with f_j the thrusts and tau_j their moments about the composite centre of mass as the
// model has them, f their sum, all in M:
//   force  = sum delta_j f_j   - mu m g R^T e_z + f x b
//   moment = sum delta_j tau_j                  + f x c
// delta_j, mu: shares by which true thrust and mass exceed the model's; c: true less modelled centre of mass; b:
// rotation vector from the true to the measured attitude. From 0 = R f_true + m_true g and the moments about the true
// centre of mass.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/robot/airframe.hpp"
#include "core/robot/allocation.hpp"

namespace eciton::estimation {

/// delta_j for every rotor there may be, mu, c (m), b (rad).
inline constexpr int model_errors = static_cast<int>(robot::rotors_max) + 7;
using ModelErrors = Eigen::Matrix<double, model_errors, 1>;
/// False wrench in M (force, N; moment about the composite centre of mass, Nm) per model error.
using BiasJacobian = Eigen::Matrix<double, 6, model_errors>;

/// One standard deviation of each error, of a module that was built and weighed with usual care.
struct ModelTolerance {
  double thrust_share = 0.03;
  double mass_share = 0.02;
  double com_m = 0.002;
  double attitude_rad = 0.006;

  ModelErrors std() const;
};

/// `rotors`: what the model says they do now. Real-time safe.
BiasJacobian bias_jacobian(const robot::Airframe& airframe, std::span<const robot::RotorOutput> rotors,
                           const robot::Vector3& com_offset_B, const robot::Matrix3& R_WM);

}  // namespace eciton::estimation
