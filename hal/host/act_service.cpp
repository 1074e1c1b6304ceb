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
      allocator_(airframe),
      descent_({}, airframe.mass_kg, airframe.I_B_kg_m2),
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
  write_joints_and_latches(now);
  if (faults_.records()) record(now);
  faults_.tell(now);
  last_step_ = now;
}

void ActService::take_commands(TimePoint now) noexcept {
  while (const auto command = rotor_command_.take()) {
    if (command->value.module_id != config_.module_id || command->value.rotors.size() != devices_.rotor_count)
      continue;
    if (descent_.phase() != robot::SafePhase::idle) {
      report(now, msg::Severity::warning, "commands came back: the safe output ends");
      descent_.reset();
    }
    last_ = command->value;
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
  for (std::size_t k = 0; k < last_.rotors.size(); ++k) {
    written_[k] = {last_.rotors[k].thrust_N, last_.rotors[k].gimbal_rad};
  }
  devices_.rotors->write(std::span(written_).first(devices_.rotor_count));
}

void ActService::write_safe_output(TimePoint now) noexcept {
  if (descent_.phase() == robot::SafePhase::idle) {
    report(now, msg::Severity::error, "no rotor command for 20 ms: safe output");
    std::array<robot::RotorOutput, robot::rotors_max> held{};
    for (std::size_t k = 0; k < last_.rotors.size(); ++k) {
      held[k] = {last_.rotors[k].thrust_N, last_.rotors[k].gimbal_rad};
    }
    allocator_.set_gimbals(std::span(held).first(devices_.rotor_count));
    const bool hold = last_.safe_output == msg::SafeOutput::hold_hover;
    robot::Wrench feed_forward_W;
    if (hold) {
      // What the last command made beyond holding the weight: it fades, the hover wrench stays.
      const auto wrench_B =
          robot::rotor_wrench_B(airframe_, std::span(held).first(devices_.rotor_count), robot::Vector3::Zero());
      const robot::Matrix3& R = attitude_.R_WB();
      feed_forward_W = {R * wrench_B.force - robot::Vector3(0, 0, airframe_.mass_kg * robot::gravity_m_s2),
                        R * wrench_B.moment};
    }
    descent_.start(hold ? robot::SafeManoeuvre::hold_hover : robot::SafeManoeuvre::descend, attitude_.R_WB(), 0,
                   feed_forward_W);
  }
  const double dt_s = std::clamp(to_s(now - last_step_), 0.0, 0.02);
  const robot::Wrench wrench_B = descent_.update(attitude_.R_WB(), attitude_.w_WB_B(), specific_force_M_, dt_s);
  if (descent_.finished()) {
    set_armed(false, now);
    return;
  }
  const robot::Allocation allocation = allocator_.update(wrench_B, robot::Vector3::Zero());
  written_ = {};
  for (std::size_t k = 0; k < allocation.rotor_count; ++k) {
    written_[k] = {allocation.rotors[k].thrust_N, allocation.rotors[k].gimbal_rad};
  }
  devices_.rotors->write(std::span(written_).first(devices_.rotor_count));
}

void ActService::watch_attitude() noexcept {
  while (const auto imu = imu_.take()) {
    if (imu->value.module_id != config_.module_id) continue;
    // One sample that is no number would stay in the filter for ever.
    if (!robot::vector(imu->value.specific_force_M_m_s2).allFinite() ||
        !robot::vector(imu->value.w_WM_M_rad_s).allFinite()) {
      continue;
    }
    const TimePoint stamp = from_ns(imu->value.stamp_ns);
    const double dt_s = std::clamp(to_s(stamp - last_imu_), 0.0, 0.02);
    last_imu_ = stamp;
    specific_force_M_ = robot::vector(imu->value.specific_force_M_m_s2);
    attitude_.update(robot::vector(imu->value.w_WM_M_rad_s), specific_force_M_, dt_s);
  }
  while (const auto state = module_state_.take()) {
    // While the estimator lives its attitude is better; when control is lost the filter goes on from it.
    if (state->value.module_id == config_.module_id && state->value.mode == msg::EstimatorMode::ready) {
      attitude_.set(robot::rotation(state->value.q_WM));
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
