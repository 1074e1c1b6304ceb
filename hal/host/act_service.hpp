// From a module's ring to its actuators, with a safe output of its own: when commands stop it holds the
// last one for 20 ms, then flies the module down on the IMU (in a chain it first holds the hover wrench).
#pragma once

#include <array>
#include <vector>

#include "core/bus/participant.hpp"
#include "core/runtime/fault_reporter.hpp"
#include "core/runtime/service.hpp"
#include "hal/devices.hpp"
#include "hal/host/safe_output.hpp"
#include "idl/topics.hpp"

namespace eciton::hal {

struct ActConfig {
  std::uint32_t module_id = 0;
  double hold_s = 0.02;      // the last command stands for so long
  double at_most_s = 0.004;  // steps without a command
  runtime::RecorderConfig recorder{};
};

class ActService final : public runtime::Service {
 public:
  static constexpr std::string_view service_name = "actuators";

  ActService(bus::Participant& ring, const ActConfig& config, const robot::Airframe& airframe, Devices& devices);

  std::string_view name() const override { return service_name; }
  runtime::Schedule schedule() override {
    return runtime::on(rotor_command_, from_s(config_.at_most_s), runtime::Phase::act);
  }
  void step(TimePoint now) noexcept override;
  std::uint32_t state_version() const noexcept override { return SafeOutput::state_version; }
  void save_state(runtime::StateWriter& writer) const noexcept override { writer(safe_); }
  void load_state(runtime::StateReader& reader) noexcept override { reader(safe_); }

  /// Before the first step: the rotors run, and this flies them.
  void go_on(const SafeOutput& flying) { safe_ = flying; }

 private:
  void take_commands(TimePoint now) noexcept;
  void write_rotors(TimePoint now) noexcept;
  void write_safe_output(TimePoint now) noexcept;
  void watch_attitude() noexcept;
  void write_joints_and_latches(TimePoint now) noexcept;
  void set_armed(bool armed, TimePoint now) noexcept;
  void report(TimePoint now, msg::Severity severity, const char* text) noexcept;
  // act_service_record.cpp
  static std::vector<runtime::Column> recorded(const Devices& devices);
  /// What this step knew and did.
  void record(TimePoint now) noexcept;

  ActConfig config_;
  robot::Airframe airframe_;
  Devices& devices_;
  SafeOutput safe_;

  bool rotors_refuse_ = false;  // to be armed
  TimePoint last_command_{};
  std::array<RotorSetpoint, robot::rotors_max> written_{};  // last
  msg::JointCommand last_joints_;
  TimePoint last_joints_at_{};
  TimePoint last_step_{};

  bus::Reader<msg::RotorCommand> rotor_command_;
  bus::Reader<msg::JointCommand> joint_command_;
  bus::Reader<msg::LatchCommand> latch_command_;
  bus::Reader<msg::Imu> imu_;
  bus::Reader<msg::ModuleState> module_state_;
  bus::Writer<msg::Event> event_;
  runtime::FaultReporter faults_;
};

}  // namespace eciton::hal
