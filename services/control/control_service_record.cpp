// What control keeps of each step for the case of a fault: the columns, and the values in their order.
#include "core/robot/arrays.hpp"
#include "services/control/control_service.hpp"

namespace eciton::control {
namespace {

enum class Sent { nothing, disarmed, armed };

void add_pose(std::vector<runtime::Column>& columns, const std::string& name, const std::string& meaning) {
  add_columns(columns, name + "_p_WM", "xyz", "m", meaning + ": position of M in W");
  add_columns(columns, name + "_q_WM", "wxyz", "", meaning + ": attitude, as a quaternion");
}

void add_rates(std::vector<runtime::Column>& columns, const std::string& name, const std::string& meaning) {
  add_columns(columns, name + "_v_WM", "xyz", "m_s", meaning + ": velocity, axes of W");
  add_columns(columns, name + "_w_WM_M", "xyz", "rad_s", meaning + ": angular velocity, axes of M");
}

}  // namespace

std::vector<runtime::Column> ControlService::recorded(const robot::Airframe& airframe) {
  std::vector<runtime::Column> columns{
      {"flight_mode", "as it left the step", runtime::words_of<msg::FlightMode>()},
      {"estimator_mode", "of the module state", runtime::words_of<msg::EstimatorMode>()},
      {"state_age_s", "of the newest module state, by its stamp"},
      {"pose_age_s", "of the last pose that estimation took, as it said"},
      {"joint_state_age_s", "of the newest one"},
      {"rotor_state_age_s", "of the newest one"},
      {"contact_wrench_age_s", "of the newest one"},
      {"members", "of the chain it flies in; 0, 1: alone"},
      {"base_id", "the chain's base"},
  };
  add_pose(columns, "state", "the newest module state");
  add_rates(columns, "state", "the newest module state");
  add_pose(columns, "reference", "what it flies to");
  add_rates(columns, "reference", "what it flies to");
  add_columns(columns, "external_force_W", "xyz", "N", "on the module, as estimation has it, axes of W");
  for (std::size_t k = 0; k < airframe.joints.size(); ++k) {
    columns.push_back({"joint" + std::to_string(k) + "_rad", k == 0 ? "measured joint angles" : ""});
  }
  columns.push_back({"sent", "the rotor command of this step", {"nothing", "disarmed", "armed"}});
  runtime::add_rotor_columns(columns, "rotor", airframe.rotors.size(), "as commanded");
  return columns;
}

void ControlService::record(TimePoint now) noexcept {
  runtime::RowFiller row = faults_.row(now);
  row(mode_, state_.mode, runtime::age_s(now, state_at_), state_.pose_age_s, runtime::age_s(now, joint_state_at_),
      runtime::age_s(now, rotor_state_at_), runtime::age_s(now, contact_wrench_at_), view_.members.size(),
      view_.base_id);
  row(state_.p_WM_m, state_.q_WM, state_.v_WM_m_s, state_.w_WM_M_rad_s);
  row(flown_.p_WM, robot::quaternion(flown_.R_WM), flown_.v_WM, flown_.w_WM_M, external_W_.force, joint_angles());
  row(!sent_ ? Sent::nothing : sent_->armed ? Sent::armed : Sent::disarmed);
  if (!sent_) return;
  for (const msg::Rotor& rotor : sent_->rotors) row(rotor.thrust_N, rotor.gimbal_rad);
}

}  // namespace eciton::control
