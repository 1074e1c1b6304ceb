// What a hardware host does with the rotors when nobody commands them: it levels and descends on the IMU, or, in a
// chain or after its own restart, first holds the hover wrench for a while.
#pragma once

#include <span>

#include "core/robot/allocation.hpp"
#include "core/robot/arrays.hpp"
#include "core/robot/attitude_filter.hpp"
#include "core/robot/safe_descent.hpp"
#include "hal/interfaces.hpp"
#include "idl/topics.hpp"

namespace eciton::hal {

/// Pure. Real-time safe; one thread.
class SafeOutput {
 public:
  static constexpr std::uint32_t state_version = 1;

  explicit SafeOutput(const robot::Airframe& airframe);

  /// A command that is good ends the safe output; true when there was one.
  bool command(const msg::RotorCommand& command) noexcept;
  const msg::RotorCommand& last_command() const { return last_; }

  /// One IMU sample. What is no number is ignored: it would stay in the filter for ever.
  void hear_imu(TimePoint stamp, const robot::Vector3& w_WM_M_rad_s,
                const robot::Vector3& specific_force_M_m_s2) noexcept;
  /// The estimator's attitude, which is better while it lives.
  void set_attitude(const robot::Matrix3& R_WM) noexcept { attitude_.set(R_WM); }

  /// What a host that comes back goes by: when it last wrote to the rotors, and whether they were powered.
  void note_written(TimePoint now, bool armed) noexcept {
    written_at_ = now;
    armed_ = armed;
  }
  TimePoint written_at() const { return written_at_; }
  bool armed() const { return armed_; }

  robot::SafePhase phase() const { return descent_.phase(); }
  bool flies() const { return phase() != robot::SafePhase::idle; }
  const robot::AttitudeFilter& attitude() const { return attitude_; }
  TimePoint last_imu() const { return last_imu_; }
  const robot::Vector3& specific_force_M_m_s2() const { return specific_force_M_; }
  /// From the last command on: it levels and descends, or holds the hover wrench if that command asked for it.
  void begin() noexcept;
  /// After `fallen_s` without any output, because this host's process died.
  void resume(double fallen_s) noexcept;
  /// One setpoint for each rotor, after `dt_s`; none when it has landed.
  std::span<const RotorSetpoint> update(double dt_s) noexcept;

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.last_, self.attitude_, self.written_at_, self.armed_);
  }

 private:
  void start(robot::SafeManoeuvre manoeuvre, double vertical_speed_m_s, bool keeps_feed_forward) noexcept;

  robot::Airframe airframe_;
  robot::Allocator allocator_;
  robot::AttitudeFilter attitude_;
  robot::SafeDescent descent_;
  msg::RotorCommand last_;
  TimePoint written_at_{};
  bool armed_ = false;
  TimePoint last_imu_{};
  robot::Vector3 specific_force_M_{0, 0, robot::gravity_m_s2};
  std::array<RotorSetpoint, robot::rotors_max> setpoints_{};
};

}  // namespace eciton::hal
