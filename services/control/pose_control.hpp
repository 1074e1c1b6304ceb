// Pose control, (4) and (5) of LEGION:
//   f   = m R^T (kp e_r + ki Int e_r + kd de_r + a_ff + g e_z)
//   tau = I (ap e_R + ai Int e_R + ad e_w + alpha_ff) + w x I w
// with e_R = log(R^T R_d), e_w = R^T R_d w_d - w, plus a feed-forward wrench.
#pragma once

#include "core/robot/trajectory.hpp"

namespace eciton::control {

using robot::Matrix3;
using robot::Vector3;
using robot::Wrench;

/// Gains in acceleration units, per axis: position in world axes, attitude in body axes.
struct PoseGains {
  Vector3 kp_1_s2, ki_1_s3, kd_1_s;
  Vector3 ap_1_s2, ai_1_s3, ad_1_s;

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.kp_1_s2, self.ki_1_s3, self.kd_1_s, self.ap_1_s2, self.ai_1_s3, self.ad_1_s);
  }
};

/// P1: assembled flight; P3: free flight and docking. Flown in simulation at 500 Hz behind actuator lags of
/// 30 ms (thrust) and 40 ms (gimbals).
PoseGains gains_assembled();
PoseGains gains_free();
/// `a` at 0, `b` at 1.
PoseGains between(const PoseGains& a, const PoseGains& b, double share);

struct PoseControlConfig {
  PoseGains gains = gains_free();
  double gain_blend_s = 0.5;           // new gains come in over this time: the output does not step
  Vector3 integral_m_s2_max{3, 3, 4};  // of the integral's part of the acceleration
  Vector3 integral_rad_s2_max{8, 8, 8};
  double position_error_m_max = 1.0;  // larger errors count as this
  double attitude_error_rad_max = 0.8;
  double correction_m_s2_max = 9;  // of errors of position and velocity together: what level rotors can give
};

/// A module as it is: M's origin is the composite centre of mass.
struct ModuleMotion {
  Vector3 p_WM = Vector3::Zero();
  Vector3 v_WM = Vector3::Zero();
  Matrix3 R_WM = Matrix3::Identity();
  Vector3 w_WM_M = Vector3::Zero();
};

struct PoseControlInput {
  ModuleMotion state;
  robot::PoseReference reference;
  double mass_kg = 0;
  Matrix3 I_M_kg_m2 = Matrix3::Identity();  // about the composite centre of mass
  Wrench feed_forward_W;                    // about the composite centre of mass, world axes
  bool integrate = true;                    // false: the integrals stay as they are
  bool force_saturated = false;             // of the last allocation: the integrals then grow no further
  bool moment_saturated = false;
};

/// Real-time safe; one thread.
class PoseControl {
 public:
  explicit PoseControl(const PoseControlConfig& config = {});

  /// Demanded wrench about the composite centre of mass, body axes, feed-forward included.
  Wrench update(const PoseControlInput& input, double dt_s);
  /// Changes over to other gains without a step; the integrals keep what they add to the output. The gains that
  /// are in force, or coming in, may be set again and again.
  void set_gains(const PoseGains& gains);
  void reset();

  Vector3 integral_m_s2() const { return integral_m_s2_; }
  Vector3 integral_rad_s2() const { return integral_rad_s2_; }
  void set_integrals(const Vector3& linear_m_s2, const Vector3& angular_rad_s2);
  const PoseGains& gains() const { return gains_; }  // in force now, in the middle of a change too

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.gains_, self.gains_from_, self.gains_to_, self.blend_s_, self.blending_, self.integral_m_s2_,
      self.integral_rad_s2_);
  }

 private:
  PoseControlConfig config_;
  PoseGains gains_, gains_from_, gains_to_;
  double blend_s_ = 0;  // time into the change
  bool blending_ = false;
  Vector3 integral_m_s2_ = Vector3::Zero();    // ki Int e_r, world axes
  Vector3 integral_rad_s2_ = Vector3::Zero();  // ai Int e_R, body axes
};

}  // namespace eciton::control
