// Flight without a state.
#include "services/control/failsafe.hpp"

namespace eciton::control {

void Failsafe::state(const robot::Matrix3& R_WM, double vertical_speed_m_s) {
  filter_.set(R_WM);
  vertical_speed_m_s_ = vertical_speed_m_s;
}

void Failsafe::imu(const robot::Vector3& w_B_rad_s, const robot::Vector3& specific_force_B_m_s2, double dt_s) {
  filter_.update(w_B_rad_s, specific_force_B_m_s2, dt_s);
  specific_force_B_ = specific_force_B_m_s2;
  imu_silent_s_ = 0;
}

void Failsafe::start(bool in_chain, const robot::Wrench& feed_forward_W) {
  descent_.start(in_chain ? robot::SafeManoeuvre::hold_hover : robot::SafeManoeuvre::hold_then_level, filter_.R_WB(),
                 vertical_speed_m_s_, feed_forward_W);
}

robot::Wrench Failsafe::update(double dt_s) {
  imu_silent_s_ += dt_s;
  const robot::Matrix3& R_WB = filter_.R_WB();
  if (!imu_missing()) return descent_.update(R_WB, filter_.w_WB_B(), specific_force_B_, dt_s);
  // An old specific force would be integrated into a speed that is not there.
  const robot::Vector3 weight_alone = R_WB.transpose() * robot::Vector3(0, 0, robot::gravity_m_s2);
  return descent_.update(R_WB, robot::Vector3::Zero(), weight_alone, dt_s);
}

}  // namespace eciton::control
