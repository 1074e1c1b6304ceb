// What control flies while the state is lost: it holds the last attitude on the IMU for a while (a restart of
// estimation takes less), then levels and descends. The same pieces serve the hardware host.
#pragma once

#include "core/robot/attitude_filter.hpp"
#include "core/robot/safe_descent.hpp"

namespace eciton::control {

struct FailsafeConfig {
  robot::AttitudeFilterConfig attitude;
  robot::SafeDescentConfig descent;
};

/// Feed it states while they are good and IMU samples always. Real-time safe; one thread.
class Failsafe {
 public:
  Failsafe(const FailsafeConfig& config, double mass_kg, const robot::Matrix3& I_kg_m2)
      : filter_(config.attitude), descent_(config.descent, mass_kg, I_kg_m2) {}

  /// A good state: attitude is taken from it as long as it lasts.
  void state(const robot::Matrix3& R_WM, double vertical_speed_m_s);
  void imu(const robot::Vector3& w_B_rad_s, const robot::Vector3& specific_force_B_m_s2, double dt_s);

  /// The state was lost. `in_chain`: its attitude is kept to the end, for neighbours hold theirs.
  void start(bool in_chain, const robot::Wrench& feed_forward_W);
  void stop() { descent_.reset(); }
  /// Wrench about the composite centre of mass, body axes.
  robot::Wrench update(double dt_s);

  bool active() const { return descent_.phase() != robot::SafePhase::idle; }
  bool finished() const { return descent_.finished(); }
  robot::SafePhase phase() const { return descent_.phase(); }
  /// No IMU sample for a while: it flies on the last attitude and the weight alone.
  bool imu_missing() const { return imu_silent_s_ > imu_silent_s_max; }

 private:
  robot::AttitudeFilter filter_;
  robot::SafeDescent descent_;
  robot::Vector3 specific_force_B_{0, 0, robot::gravity_m_s2};
  double vertical_speed_m_s_ = 0;
  static constexpr double imu_silent_s_max = 0.05;
  double imu_silent_s_ = 0;
};

}  // namespace eciton::control
