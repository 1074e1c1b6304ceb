// From the sensors of a module to its ring: reads every device once a period and publishes what is new.
#pragma once

#include <array>
#include <vector>

#include "core/bus/participant.hpp"
#include "core/runtime/service.hpp"
#include "hal/devices.hpp"
#include "idl/topics.hpp"

namespace eciton::hal {

struct SenseConfig {
  std::uint32_t module_id = 0;
  double rate_Hz = 500;
  double slow_rate_Hz = 100;  // rotor and joint states
};

class SenseService final : public runtime::Service {
 public:
  SenseService(bus::Participant& ring, const SenseConfig& config, Devices& devices);

  std::string_view name() const override { return "hardware"; }
  runtime::Schedule schedule() override { return runtime::every(period_, runtime::Phase::sense); }
  void step(TimePoint now) noexcept override;

  /// Whether the last step published an IMU sample: lockstep's clock says so to those triggered by it.
  bool imu_sampled() const { return imu_sampled_; }

 private:
  void publish_imu(TimePoint now) noexcept;
  void publish_pose() noexcept;
  void publish_actuators(TimePoint now) noexcept;
  void publish_latches(TimePoint now) noexcept;

  std::uint32_t module_id_;
  Duration period_;
  Duration slow_period_;
  TimePoint slow_due_{};
  Devices& devices_;
  bool imu_sampled_ = false;
  std::vector<LatchReading> latch_published_;
  std::vector<bool> latch_known_;

  bus::Writer<msg::Imu> imu_;
  bus::Writer<msg::PoseMeasurement> pose_;
  bus::Writer<msg::RotorState> rotor_state_;
  bus::Writer<msg::JointState> joint_state_;
  bus::Writer<msg::LatchState> latch_state_;
};

}  // namespace eciton::hal
