// What flies a module down when nobody commands it any more: on attitude and IMU alone it levels and
// descends, or, in a chain, first holds the hover wrench for a while. Used by control when estimation is
// lost and by the hardware host when control is.
#pragma once

#include "core/robot/airframe.hpp"

namespace eciton::robot {

enum class SafeManoeuvre {
  descend,          // alone: level and descend at once
  hold_then_level,  // alone: hold attitude and hover, the feed-forward fading, then level and descend
  hold_hover        // in a chain: the same, but descend in that attitude, for neighbours hold theirs
};

enum class SafePhase { idle, holding, descending, landed };

struct SafeDescentConfig {
  double hold_s = 2.0;  // not for SafeManoeuvre::descend
  double feed_forward_time_constant_s = 0.5;
  double descent_m_s = 0.5;
  double vertical_gain_1_s = 2.0;  // on the vertical speed integrated from the accelerometer
  double force_share_min = 0.8;    // of the weight
  double force_share_max = 1.15;
  double ground_jolt_m_s2 = 5;  // upward, beyond what the thrust makes; gusts stay below 1
  double attitude_gain_1_s2 = 40;
  double rate_gain_1_s = 12;
  double attitude_error_rad_max = 0.3;  // larger errors are worked off at a bounded rate
  double landed_s = 0.7;                // not falling for so long, though asked to: standing
  double descent_s_max = 40;            // then the motors stop in any case
};

/// Real-time safe; one thread.
class SafeDescent {
 public:
  SafeDescent(const SafeDescentConfig& config, double mass_kg, const Matrix3& I_kg_m2);

  /// Begins. `feed_forward_W`: of the last good output, about the composite centre of mass, world axes.
  void start(SafeManoeuvre manoeuvre, const Matrix3& R_WB, double vertical_speed_m_s, const Wrench& feed_forward_W);
  void reset() { phase_ = SafePhase::idle; }

  /// Wrench to allocate, about the composite centre of mass, body axes; zero when landed or idle.
  Wrench update(const Matrix3& R_WB, const Vector3& w_WB_B_rad_s, const Vector3& specific_force_B_m_s2, double dt_s);

  SafePhase phase() const { return phase_; }
  /// The motors shall be off: landed, or out of time.
  bool finished() const { return phase_ == SafePhase::landed; }
  double elapsed_s() const { return elapsed_s_; }
  double vertical_speed_m_s() const { return vertical_speed_m_s_; }

 private:
  Vector3 attitude_error(const Matrix3& R_WB) const;

  SafeDescentConfig config_;
  double mass_kg_;
  Matrix3 I_kg_m2_;
  SafePhase phase_ = SafePhase::idle;
  SafeManoeuvre manoeuvre_ = SafeManoeuvre::descend;
  Matrix3 R_WB_hold_ = Matrix3::Identity();
  Wrench feed_forward_W_;
  double elapsed_s_ = 0;
  double descending_s_ = 0;
  double at_least_s_ = 0;
  double vertical_speed_m_s_ = 0;
  double force_share_ = 1;  // asked for last, of the weight
};

}  // namespace eciton::robot
