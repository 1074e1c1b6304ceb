// Attitude, descent, allocation.
#include "hal/host/safe_output.hpp"

#include <algorithm>
#include <array>

namespace eciton::hal {

using robot::Vector3;

SafeOutput::SafeOutput(const robot::Airframe& airframe)
    : airframe_(airframe), allocator_(airframe), descent_({}, airframe.mass_kg, airframe.I_B_kg_m2) {}

bool SafeOutput::command(const msg::RotorCommand& command) noexcept {
  last_ = command;
  const bool flew = flies();
  descent_.reset();
  return flew;
}

void SafeOutput::hear_imu(TimePoint stamp, const Vector3& w_WM_M_rad_s,
                          const Vector3& specific_force_M_m_s2) noexcept {
  if (!specific_force_M_m_s2.allFinite() || !w_WM_M_rad_s.allFinite()) return;
  const double dt_s = std::clamp(to_s(stamp - last_imu_), 0.0, 0.02);
  last_imu_ = stamp;
  specific_force_M_ = specific_force_M_m_s2;
  attitude_.update(w_WM_M_rad_s, specific_force_M_, dt_s);
}

void SafeOutput::begin() noexcept {
  const bool hold = last_.safe_output == msg::SafeOutput::hold_hover;
  start(hold ? robot::SafeManoeuvre::hold_hover : robot::SafeManoeuvre::descend, 0, hold);
}

void SafeOutput::resume(double fallen_s) noexcept {
  const bool in_chain = last_.safe_output == msg::SafeOutput::hold_hover;
  // Its neighbours hold up what is linked to them.
  const double vertical_speed_m_s = in_chain ? 0 : -robot::gravity_m_s2 * fallen_s;
  start(in_chain ? robot::SafeManoeuvre::hold_hover : robot::SafeManoeuvre::hold_then_level, vertical_speed_m_s,
        true);
}

void SafeOutput::start(robot::SafeManoeuvre manoeuvre, double vertical_speed_m_s, bool keeps_feed_forward) noexcept {
  std::array<robot::RotorOutput, robot::rotors_max> held{};
  const std::size_t rotors = std::min<std::size_t>(last_.rotors.size(), airframe_.rotors.size());
  for (std::size_t k = 0; k < rotors; ++k) held[k] = {last_.rotors[k].thrust_N, last_.rotors[k].gimbal_rad};
  const std::span all = std::span(held).first(airframe_.rotors.size());
  allocator_.set_gimbals(all);
  robot::Wrench feed_forward_W;
  if (keeps_feed_forward) {
    // What the last command made beyond holding the weight: it fades, the hover wrench stays.
    const auto wrench_B = robot::rotor_wrench_B(airframe_, all, Vector3::Zero());
    const robot::Matrix3& R = attitude_.R_WB();
    feed_forward_W = {R * wrench_B.force - Vector3(0, 0, airframe_.mass_kg * robot::gravity_m_s2),
                      R * wrench_B.moment};
  }
  descent_.start(manoeuvre, attitude_.R_WB(), vertical_speed_m_s, feed_forward_W);
}

std::span<const RotorSetpoint> SafeOutput::update(double dt_s) noexcept {
  const robot::Wrench wrench_B = descent_.update(attitude_.R_WB(), attitude_.w_WB_B(), specific_force_M_, dt_s);
  if (descent_.finished()) return {};
  const robot::Allocation allocation = allocator_.update(wrench_B, Vector3::Zero());
  for (std::size_t k = 0; k < allocation.rotor_count; ++k) {
    setpoints_[k] = {allocation.rotors[k].thrust_N, allocation.rotors[k].gimbal_rad};
  }
  return std::span(setpoints_).first(allocation.rotor_count);
}

}  // namespace eciton::hal
