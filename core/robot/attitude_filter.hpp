// Attitude from gyroscope and accelerometer alone, for the hardware host's fail-safe: the gyroscope is
// integrated, gravity slowly corrects roll, pitch and the gyroscope's bias. Yaw drifts.
#pragma once

#include "core/robot/frames.hpp"

namespace eciton::robot {

struct AttitudeFilterConfig {
  double correction_rate_1_s = 0.5;
  double bias_rate_1_s2 = 0.02;
  double gravity_share_max = 0.15;  // no correction while |specific force| is further than this from 1 g
  double bias_rad_s_max = 0.05;
};

/// Complementary filter on SO(3) (Mahony). Real-time safe; one thread.
class AttitudeFilter {
 public:
  explicit AttitudeFilter(const AttitudeFilterConfig& config = {}) : config_(config) {}

  /// Takes an attitude that is known better, as the estimator's while it lives.
  void set(const Matrix3& R_WB);
  /// One IMU sample, body axes. The first one sets roll and pitch, yaw zero, unless `set` came before.
  void update(const Vector3& w_B_rad_s, const Vector3& specific_force_B_m_s2, double dt_s);

  bool ready() const { return ready_; }
  const Matrix3& R_WB() const { return R_WB_; }
  const Vector3& w_WB_B() const { return w_B_; }  // bias taken off
  const Vector3& bias_rad_s() const { return bias_; }

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.ready_, self.R_WB_, self.w_B_, self.bias_);
  }

 private:
  AttitudeFilterConfig config_;
  bool ready_ = false;
  Matrix3 R_WB_ = Matrix3::Identity();
  Vector3 w_B_ = Vector3::Zero();
  Vector3 bias_ = Vector3::Zero();
};

}  // namespace eciton::robot
