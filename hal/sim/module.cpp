// One simulated module: from commands to forces, from motion to readings.
#include "hal/sim/module.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::hal::sim {
namespace {

using robot::Matrix3;
using robot::Vector3;

constexpr int reading_period_steps = 2;  // servos and ESCs are read once per 2 ms cycle

PoseSourceKind source_kind(const WorldConfig& config) {
  return config.sensing == "lio" ? PoseSourceKind::lio : PoseSourceKind::mocap;
}

}  // namespace

SimModule::SimModule(const WorldConfig& config, const robot::Airframe& airframe, const ModuleStart& start,
                     const ModuleIndex& index, const Mismatch& mismatch)
    : gust(Random(config.seed, start.id, Purpose::gust)),
      wake(Random(config.seed, start.id, Purpose::wake)),
      airframe_(&airframe),
      index_(index),
      mismatch_(mismatch),
      thrust_map_(robot::thrust_map(airframe)),
      battery_(config.battery),
      battery_noise_V_(config.noise * config.battery.noise_V),
      battery_random_(config.seed, start.id, Purpose::battery),
      reading_config_(config.readings),
      noise_(config.noise),
      reading_random_(config.seed, start.id, Purpose::readings),
      imu_(config.imu, config.noise, Random(config.seed, start.id, Purpose::imu),
           Random(config.seed, start.id, Purpose::imu_fault)),
      pose_(config.pose_sensor(), source_kind(config), config.noise, mismatch.attitude_bias_rad,
            Random(config.seed, start.id, Purpose::pose), Random(config.seed, start.id, Purpose::drift),
            Random(config.seed, start.id, Purpose::pose_fault)) {
  for (const robot::RotorGeometry& rotor : airframe.rotors) {
    rotors_.emplace_back(rotor, start.hovering ? airframe.hover_thrust_N() : 0.0);
  }
  for (std::size_t k = 0; k < airframe.joints.size(); ++k) {
    joints_.emplace_back(airframe.joints[k], mismatch.joint_offset_rad[k]);
  }
  if (start.hovering) {
    command_.armed = command_.joints_powered = true;
    battery_.step(1, 0);
    for (std::size_t k = 0; k < rotors_.size(); ++k) {
      command_.rotors[k].thrust_N = airframe.hover_thrust_N();
      command_.throttle_percent[k] = thrust_map_.percent(airframe.hover_thrust_N(), battery_.voltage_V());
    }
  }
}

robot::Pose SimModule::X_WB(const mjData* d) const {
  const double* q = d->qpos + index_.qpos;
  return {Eigen::Map<const Vector3>(q), robot::Quaternion(q[3], q[4], q[5], q[6]).normalized().toRotationMatrix()};
}

void SimModule::joint_angles(const mjData* d, std::span<double> joint_rad) const {
  for (std::size_t k = 0; k < joints_.size(); ++k) joint_rad[k] = d->qpos[index_.joint_qpos[k]];
}

void SimModule::step_actuators(mjData* d) {
  step_rotors();
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    d->qfrc_applied[index_.joint_dof[k]] =
        joints_[k].step(command_.joints[k], command_.joints_powered, d->qpos[index_.joint_qpos[k]], step_s);
  }
}

void SimModule::step_rotors() {
  const double hover_N = airframe_->hover_thrust_N();
  double load = 0;
  for (std::size_t k = 0; k < rotors_.size(); ++k) {
    const double thrust_N = thrust_map_.thrust_N(command_.throttle_percent[k], battery_.voltage_V());
    rotors_[k].step({.thrust_N = thrust_N, .gimbal_rad = command_.rotors[k].gimbal_rad}, command_.armed, step_s);
    const double share = rotors_[k].thrust_N() / hover_N;
    load += share * std::sqrt(std::max(share, 0.0)) / static_cast<double>(rotors_.size());
  }
  battery_.step(load, step_s);
}

robot::Wrench SimModule::rotor_wrench_B_W(const Matrix3& R_WB) const {
  robot::Wrench sum_B;
  for (std::size_t k = 0; k < rotors_.size(); ++k) {
    const robot::RotorGeometry& rotor = airframe_->rotors[k];
    const Vector3 force = mismatch_.thrust_scale[k] * rotors_[k].thrust_N() * rotors_[k].direction_B();
    sum_B += robot::shift({force, rotor.drag_ratio_m * force}, rotor.p_BR_m);
  }
  return {R_WB * sum_B.force, R_WB * sum_B.moment};
}

double SimModule::thrust_N() const {
  double sum_N = 0;
  for (const RotorActuator& rotor : rotors_) sum_N += rotor.thrust_N();
  return sum_N;
}

void SimModule::apply(const robot::Wrench& about_B_W, const Matrix3& R_WB, mjData* d) const {
  const robot::Wrench about_com = robot::shift(about_B_W, -(R_WB * index_.p_B_com_m));
  double* out = d->xfrc_applied + 6 * index_.body;
  Eigen::Map<Vector3>(out + 0) = about_com.force;
  Eigen::Map<Vector3>(out + 3) = about_com.moment;
}

void SimModule::step_sensors(TimePoint now, const mjData* d, const Vector3& v_before, const Matrix3& R_before) {
  const Vector3 w_B = w_WB_B(d);
  const Vector3 f_W = (v_WB(d) - v_before) / step_s + robot::gravity_m_s2 * Vector3::UnitZ();
  const Vector3 f_B = R_before.transpose() * f_W;
  imu_.step(now, f_B - 0.5 * step_s * w_B.cross(f_B), w_B);  // in the axes of the step's middle
  pose_.step(now, X_WB(d));
  if (++steps_ % reading_period_steps == 0) sample_readings(d);
}

void SimModule::start_sensors(TimePoint now, const mjData* d) {
  const robot::Pose X = X_WB(d);
  const Vector3 a_W = Eigen::Map<const Vector3>(d->qacc + index_.dof);
  imu_.step(now, X.R.transpose() * (a_W + robot::gravity_m_s2 * Vector3::UnitZ()), w_WB_B(d));
  pose_.step(now, X);
  sample_readings(d);
}

void SimModule::sample_readings(const mjData* d) {
  const auto noisy = [&](double value, double deviation) {
    return value + noise_ * deviation * reading_random_.normal();
  };
  const double battery_V = battery_.voltage_V() + battery_noise_V_ * battery_random_.normal();
  for (std::size_t k = 0; k < rotors_.size(); ++k) {
    rotor_readings_[k].thrust_N = noisy(rotors_[k].thrust_N(), reading_config_.thrust_noise_N);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      rotor_readings_[k].gimbal_rad[axis] = noisy(rotors_[k].gimbal_rad()[axis], reading_config_.gimbal_noise_rad);
    }
    rotor_readings_[k].battery_V = battery_V;
  }
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const double position_rad = joints_[k].encoder_rad(d->qpos[index_.joint_qpos[k]]);
    joint_readings_[k].position_rad = noisy(position_rad, reading_config_.joint_noise_rad);
    joint_readings_[k].velocity_rad_s =
        noisy(d->qvel[index_.joint_dof[k]], reading_config_.joint_velocity_noise_rad_s);
    joint_readings_[k].torque_Nm = noisy(joints_[k].torque_Nm(), reading_config_.joint_torque_noise_Nm);
  }
}

void SimModule::fill(SensorFrame& frame) const {
  frame.module_id = id();
  frame.rotor_count = static_cast<std::uint32_t>(rotors_.size());
  frame.joint_count = static_cast<std::uint32_t>(joints_.size());
  frame.port_count = static_cast<std::uint32_t>(airframe_->ports.size());
  frame.imu = imu_.reading();
  frame.imu_count = imu_.count();
  frame.pose_count = pose_.count();
  frame.pose = pose_.reading();
  frame.rotors = rotor_readings_;
  frame.joints = joint_readings_;
}

void SimModule::break_sensor(SimSensor sensor, const SensorFault& fault, TimePoint now) {
  if (sensor == SimSensor::imu) {
    imu_.set_fault(fault, now);
  } else {
    pose_.set_fault(fault, now);
  }
}

}  // namespace eciton::hal::sim
