// take(); write(); and what to do when there is nothing to take.
#include "hal/host/act_service.hpp"

#include <algorithm>
#include <array>

#include "core/robot/arrays.hpp"

namespace eciton::hal {

ActService::ActService(bus::Participant& ring, const ActConfig& config, const robot::Airframe& airframe,
                       Devices& devices)
    : config_(config),
      airframe_(airframe),
      devices_(devices),
      safe_(airframe),
      rotor_command_(ring.create_reader(topics::rotor_command)),
      joint_command_(ring.create_reader(topics::joint_command)),
      latch_command_(ring.create_reader(topics::latch_command)),
      imu_(ring.create_reader(topics::imu)),
      module_state_(ring.create_reader(topics::module_state)),
      event_(ring.create_writer(topics::event)),
      faults_(ring, config.module_id, "hardware", config.recorder, recorded(devices)) {}

void ActService::step(TimePoint now) noexcept {
  watch_attitude();
  take_commands(now);
  if (devices_.armed && now - last_command_ > from_s(config_.hold_s)) {
    write_safe_output(now);
  } else {
    write_rotors(now);
  }
  safe_.note_written(now, devices_.armed);
  write_joints_and_latches(now);
  if (faults_.records()) record(now);
  faults_.tell(now);
  last_step_ = now;
}

void ActService::take_commands(TimePoint now) noexcept {
  while (const auto command = rotor_command_.take()) {
    if (command->value.module_id != config_.module_id || command->value.rotors.size() != devices_.rotor_count)
      continue;
    if (safe_.command(command->value)) {
      report(now, msg::Severity::warning, "commands came back: the safe output ends");
    }
    last_command_ = now;
    set_armed(command->value.armed, now);
  }
}

void ActService::set_armed(bool armed, TimePoint now) noexcept {
  if (!armed) rotors_refuse_ = false;
  if (armed == devices_.armed || rotors_refuse_) return;
  // Bounded and real-time safe on the backends of this tree: they switch a flag that the next frame carries.
  if (!armed) {
    devices_.rotors->deactivate();
  } else if (!devices_.rotors->activate()) {
    rotors_refuse_ = true;  // said once; asked again when it was disarmed in between
    report(now, msg::Severity::error, "the rotors' bus refuses to activate");
    return;
  }
  devices_.armed = armed;
  msg::Event out{.module_id = config_.module_id, .stamp_ns = to_ns(now), .service = "hardware", .machine = "rotors"};
  out.from = armed ? "inactive" : "active";
  out.to = armed ? "active" : "inactive";
  event_.write(out);
}

void ActService::write_rotors(TimePoint) noexcept {
  written_ = {};
  const auto& rotors = safe_.last_command().rotors;
  for (std::size_t k = 0; k < rotors.size(); ++k) written_[k] = {rotors[k].thrust_N, rotors[k].gimbal_rad};
  devices_.rotors->write(std::span(written_).first(devices_.rotor_count));
}

void ActService::write_safe_output(TimePoint now) noexcept {
  if (!safe_.flies()) {
    report(now, msg::Severity::error, "no rotor command for 20 ms: safe output");
    safe_.begin();
  }
  const std::span<const RotorSetpoint> setpoints = safe_.update(std::clamp(to_s(now - last_step_), 0.0, 0.02));
  if (setpoints.empty()) {
    set_armed(false, now);
    return;
  }
  written_ = {};
  std::copy(setpoints.begin(), setpoints.end(), written_.begin());
  devices_.rotors->write(setpoints);
}

void ActService::watch_attitude() noexcept {
  while (const auto imu = imu_.take()) {
    const msg::Imu& m = imu->value;
    if (m.module_id != config_.module_id) continue;
    safe_.hear_imu(from_ns(m.stamp_ns), robot::vector(m.w_WM_M_rad_s), robot::vector(m.specific_force_M_m_s2));
  }
  while (const auto state = module_state_.take()) {
    // While the estimator lives its attitude is better; when control is lost the filter goes on from it.
    if (state->value.module_id == config_.module_id && state->value.mode == msg::EstimatorMode::ready) {
      safe_.set_attitude(robot::rotation(state->value.q_WM));
    }
  }
}

void ActService::write_joints_and_latches(TimePoint now) noexcept {
  while (const auto command = joint_command_.take()) {
    if (command->value.module_id != config_.module_id || command->value.joints.size() != devices_.joint_count)
      continue;
    std::array<JointSetpoint, robot::joints_max> setpoints{};
    for (std::size_t k = 0; k < command->value.joints.size(); ++k) {
      setpoints[k] = {command->value.joints[k].position_rad, command->value.joints[k].velocity_rad_s};
    }
    devices_.joints->write(std::span(setpoints).first(devices_.joint_count));
    last_joints_ = command->value;
    last_joints_at_ = now;
  }
  while (const auto command = latch_command_.take()) {
    if (command->value.module_id != config_.module_id || command->value.port >= devices_.latches.size()) continue;
    devices_.latches[command->value.port]->write(command->value.engage);
  }
}

void ActService::report(TimePoint now, msg::Severity severity, const char* text) noexcept {
  faults_.raise(now, severity, "rotors", text);
}

}  // namespace eciton::hal
