// What is false in an airframe's model, and what wrench that looks like: rotors that push harder or softer than they
// should, mass, centre of mass, and the attitude that the pose sensor gives. A module in hover is pushed by this
// false wrench, an observer reads it, and it turns with the module as each error does.
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

namespace eciton::robot {

/// delta_j for every rotor there may be, mu, c (m), b (rad).
inline constexpr int error_mass = static_cast<int>(rotors_max), error_com = error_mass + 1,
                     error_attitude = error_com + 3, model_error_count = error_attitude + 3;
using ModelErrors = Eigen::Matrix<double, model_error_count, 1>;
/// False wrench in M (force, N; moment about the composite centre of mass, Nm) per model error.
using BiasJacobian = Eigen::Matrix<double, 6, model_error_count>;

/// One standard deviation of each error, of a module that was built and weighed with usual care.
struct ModelTolerance {
  double thrust_share = 0.03;
  double mass_share = 0.02;
  double com_m = 0.002;
  double attitude_rad = 0.006;

  ModelErrors std() const;
};

/// `rotors`: what the model says they do now. Real-time safe.
BiasJacobian bias_jacobian(const Airframe& airframe, std::span<const RotorOutput> rotors, const Vector3& com_offset_B,
                           const Matrix3& R_WM);

Wrench false_wrench_M(const BiasJacobian& jacobian_M, const ModelErrors& errors);

}  // namespace eciton::robot
