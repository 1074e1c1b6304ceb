// What the hardware host keeps of each step for the case of a fault: the columns, and the values in their order.
#include <limits>

#include "core/robot/arrays.hpp"
#include "hal/host/act_service.hpp"

namespace eciton::hal {

std::vector<runtime::Column> ActService::recorded(const Devices& devices) {
  std::vector<runtime::Column> columns{
      {"rotors_armed", "whether the rotors are powered", {"no", "yes"}},
      {"safe_output", "idle: control's commands are obeyed, or held", {"idle", "holding", "descending", "landed"}},
      {"command_armed", "of the last rotor command", {"no", "yes"}},
      {"command_safe_output", "what it asked for in case no other follows", runtime::words_of<msg::SafeOutput>()},
      {"command_taken_s", "how long ago it was taken"},
      {"command_age_s", "by its stamp"},
      {"command_state_age_s", "of the module state that control acted on"},
  };
  runtime::add_rotor_columns(columns, "commanded", devices.rotor_count, "the last rotor command");
  runtime::add_rotor_columns(columns, "written", devices.rotor_count, "what was last written to the rotors' bus");
  columns.push_back({"joint_command_taken_s", "how long ago the last joint command was taken"});
  for (std::size_t k = 0; k < devices.joint_count; ++k) {
    columns.push_back({"joint" + std::to_string(k) + "_target_rad", k == 0 ? "the last joint command" : ""});
  }
  columns.push_back({"imu_age_s", "of the newest IMU sample"});
  add_columns(columns, "specific_force_M", "xyz", "m_s2", "as the IMU says");
  add_columns(columns, "w_WM_M", "xyz", "rad_s", "angular velocity, as the attitude filter has it, axes of M");
  add_columns(columns, "q_WM", "wxyz", "", "attitude of the safe output's filter, as a quaternion");
  return columns;
}

void ActService::record(TimePoint now) noexcept {
  runtime::RowFiller row = faults_.row(now);
  const msg::RotorCommand& last = safe_.last_command();
  row(devices_.armed, safe_.phase(), last.armed, last.safe_output, runtime::age_s(now, last_command_),
      runtime::age_s(now, from_ns(last.stamp_ns)), runtime::age_s(now, from_ns(last.state_stamp_ns)));
  // Before the first command there is none: the columns stay in place.
  for (std::size_t k = 0; k < devices_.rotor_count; ++k) {
    const msg::Rotor rotor = k < last.rotors.size() ? last.rotors[k] : msg::Rotor{};
    row(rotor.thrust_N, rotor.gimbal_rad);
  }
  for (std::size_t k = 0; k < devices_.rotor_count; ++k) row(written_[k].thrust_N, written_[k].gimbal_rad);
  row(runtime::age_s(now, last_joints_at_));
  for (std::size_t k = 0; k < devices_.joint_count; ++k) {
    row(k < last_joints_.joints.size() ? last_joints_.joints[k].position_rad
                                       : std::numeric_limits<double>::quiet_NaN());
  }
  const robot::AttitudeFilter& attitude = safe_.attitude();
  row(runtime::age_s(now, safe_.last_imu()), safe_.specific_force_M_m_s2(), attitude.w_WB_B(),
      robot::quaternion(attitude.R_WB()));
}

}  // namespace eciton::hal
