// Lets a joint in a link give way: its servo's reference moves until the servo carries no more than the joint's own
// friction and its link's weight, so that neighbours that disagree by milliradians do not strain the link between
// them.
//   x' = - (rate / stiffness) (torque - weight - friction * reference rate) - x / T,   |x| <= give
// It forgets in T: a lasting strain is the contact-wrench law's to take out, which two integrals would fight over.
#pragma once

#include "core/robot/airframe.hpp"

namespace eciton::joints {

struct JointReliefConfig {
  double rate_1_s = 20;           // of the torque, while the neighbours' inertia holds them still; 0: stiff joints
  double stiffness_Nm_rad = 120;  // of the position servo
  double friction_Nm_s_rad = 2;   // viscous, of the joint: the servo's to overcome while it morphs
  double give_rad = 0.06;         // at most: a joint's offset and both neighbours' attitude errors
  double return_time_constant_s = 2;  // T
};

/// Torque of a joint's servo that bears the weight of its dock link alone, Nm, at an angle and an attitude of the
/// module.
double weight_torque_Nm(const robot::JointGeometry& joint, double position_rad, const robot::Matrix3& R_WM);

/// One joint. Real-time safe.
class JointRelief {
 public:
  explicit JointRelief(const JointReliefConfig& config = {}) : config_(config) {}

  /// `strain_Nm`: the servo's torque as measured less the weight it bears; `reference_rad_s` the motion asked for.
  /// Returns what to add to the reference, rad. A strain that is not finite changes nothing.
  double update(double strain_Nm, double reference_rad_s, double dt_s);
  /// In no link: back to the reference itself.
  double let_go(double dt_s);
  double give_rad() const { return give_rad_; }

 private:
  JointReliefConfig config_;
  double give_rad_ = 0;
};

}  // namespace eciton::joints
