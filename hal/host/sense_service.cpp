// read(); publish();
#include "hal/host/sense_service.hpp"

#include <array>

namespace eciton::hal {

SenseService::SenseService(bus::Participant& ring, const SenseConfig& config, Devices& devices)
    : module_id_(config.module_id),
      period_(from_s(1 / config.rate_Hz)),
      slow_period_(from_s(1 / config.slow_rate_Hz)),
      devices_(devices),
      latch_published_(devices.latches.size()),
      latch_known_(devices.latches.size(), false),
      imu_(ring.create_writer(topics::imu)),
      pose_(ring.create_writer(topics::pose_measurement)),
      rotor_state_(ring.create_writer(topics::rotor_state)),
      joint_state_(ring.create_writer(topics::joint_state)),
      latch_state_(ring.create_writer(topics::latch_state)) {}

void SenseService::step(TimePoint now) noexcept {
  publish_imu(now);
  publish_pose();
  publish_latches(now);
  if (now >= slow_due_) {
    publish_actuators(now);
    slow_due_ = now + slow_period_;
  }
}

void SenseService::publish_imu(TimePoint) noexcept {
  ImuReading reading;
  imu_sampled_ = devices_.imu->read(reading) == Io::ok;
  if (!imu_sampled_) return;
  msg::Imu out;
  out.module_id = module_id_;
  out.stamp_ns = to_ns(reading.stamp);
  out.specific_force_M_m_s2 = reading.specific_force_M_m_s2;
  out.w_WM_M_rad_s = reading.w_WM_M_rad_s;
  imu_.write(out);
}

void SenseService::publish_pose() noexcept {
  PoseReading reading;
  if (devices_.pose->read(reading) != Io::ok) return;
  msg::PoseMeasurement out;
  out.module_id = module_id_;
  out.stamp_ns = to_ns(reading.stamp);
  out.source = reading.source == PoseSourceKind::lio ? msg::PoseSourceKind::lio : msg::PoseSourceKind::mocap;
  out.p_WB_m = reading.p_WB_m;
  out.q_WB = reading.q_WB;
  out.position_std_m = reading.position_std_m;
  out.attitude_std_rad = reading.attitude_std_rad;
  pose_.write(out);
}

void SenseService::publish_actuators(TimePoint now) noexcept {
  std::array<RotorReading, 8> rotors{};
  if (devices_.rotors->read(std::span(rotors).first(devices_.rotor_count)) == Io::ok) {
    msg::RotorState out;
    out.module_id = module_id_;
    out.stamp_ns = to_ns(now);
    out.armed = devices_.armed;
    out.battery_V = rotors[0].battery_V;
    for (std::size_t k = 0; k < devices_.rotor_count; ++k) {
      out.rotors.push_back({rotors[k].thrust_N, rotors[k].gimbal_rad});
    }
    rotor_state_.write(out);
  }
  std::array<JointReading, 8> joints{};
  if (devices_.joints->read(std::span(joints).first(devices_.joint_count)) == Io::ok) {
    msg::JointState out;
    out.module_id = module_id_;
    out.stamp_ns = to_ns(now);
    for (std::size_t k = 0; k < devices_.joint_count; ++k) {
      out.joints.push_back({joints[k].position_rad, joints[k].velocity_rad_s, joints[k].torque_Nm});
    }
    joint_state_.write(out);
  }
}

void SenseService::publish_latches(TimePoint now) noexcept {
  for (std::size_t port = 0; port < devices_.latches.size(); ++port) {
    LatchReading reading{};
    if (devices_.latches[port]->read(reading) != Io::ok) continue;
    if (latch_known_[port] && reading == latch_published_[port]) continue;
    latch_known_[port] = true;
    latch_published_[port] = reading;
    msg::LatchState out;
    out.module_id = module_id_;
    out.port = static_cast<std::uint32_t>(port);
    out.stamp_ns = to_ns(now);
    out.status = static_cast<msg::LatchStatus>(reading);
    latch_state_.write(out);
  }
}

}  // namespace eciton::hal
