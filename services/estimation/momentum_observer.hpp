// External wrench from momentum, (7) of LEGION in its exact zero-order-hold form:
//   u = [R f + m g; tau - w x I w],  w_ext <- a w_ext + (1 - a) [(p - p_before) / dt - u],  a = exp(-K dt)
// with p = [m v_W; I w_M] and (f, tau) the wrench the rotors make. Unconditionally stable.
#pragma once

#include "core/robot/frames.hpp"

namespace eciton::estimation {

struct MomentumObserverConfig {
  double force_gain_1_s = 8;  // K: 6 to 10
  double moment_gain_1_s = 8;
};

/// One module at one time. M: origin at the composite centre of mass.
struct MomentumInput {
  double mass_kg = 0;
  robot::Matrix3 I_M_kg_m2 = robot::Matrix3::Identity();  // about the composite centre of mass, body axes
  robot::Vector3 v_WM = robot::Vector3::Zero();
  robot::Vector3 w_WM_M = robot::Vector3::Zero();
  robot::Matrix3 R_WM = robot::Matrix3::Identity();
  robot::Wrench known_M;  // of the rotors, as modelled with their lag; about the composite centre, body axes
};

/// Real-time safe; one thread.
class MomentumObserver {
 public:
  explicit MomentumObserver(const MomentumObserverConfig& config = {}) : config_(config) {}

  /// `input` at the end of an interval of `dt_s`; the known wrench over it is the mean of both ends'. False: not
  /// finite, and left alone.
  [[nodiscard]] bool update(const MomentumInput& input, double dt_s);
  /// The velocity is about to jump (the filter restarted): the next update only takes the momentum.
  void hold() { has_momentum_ = false; }
  void reset();

  /// On the module, about its composite centre of mass, world axes.
  robot::Wrench wrench_W() const { return {force_W_, R_WM_ * moment_M_}; }

 private:
  MomentumObserverConfig config_;
  bool has_momentum_ = false;
  robot::Vector3 p_linear_W_ = robot::Vector3::Zero(), p_angular_M_ = robot::Vector3::Zero();
  robot::Vector3 u_linear_W_ = robot::Vector3::Zero(), u_angular_M_ = robot::Vector3::Zero();
  robot::Matrix3 R_WM_ = robot::Matrix3::Identity();
  robot::Vector3 force_W_ = robot::Vector3::Zero();
  robot::Vector3 moment_M_ = robot::Vector3::Zero();  // body axes: turned only where it leaves
};

}  // namespace eciton::estimation
