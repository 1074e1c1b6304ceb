// What the docking service knows of the modules around it, its own among them: where they are, what they do
// and how lately they were heard.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/bus/participant.hpp"
#include "core/robot/kinematics.hpp"
#include "idl/topics.hpp"

namespace eciton::docking {

struct HeardModule {
  std::uint32_t id = 0;  // 0: a free place
  TimePoint heard{};
  TimePoint state_at{};
  msg::ModuleState state;
  msg::DockingState docking;  // our own is not kept here
  robot::Vector3 external_force_W = robot::Vector3::Zero();
  std::array<double, robot::joints_max> joint_rad{};
  bool flying = false;
  bool zeroed = false;
};

/// Real-time safe; one thread.
class HeardModules {
 public:
  static constexpr std::size_t bound = 33;

  HeardModules(bus::Participant& ring, std::uint32_t own_id, const robot::Airframe& airframe);

  void take(TimePoint now) noexcept;

  std::span<const HeardModule> all() const { return modules_; }
  const HeardModule& own() const { return modules_[0]; }
  /// Our own radio's, if one came with the last take.
  const std::optional<msg::Heartbeat>& radio_beat() const { return radio_beat_; }
  /// Nothing when it was never heard.
  const HeardModule* find(std::uint32_t id) const noexcept;
  /// `near`: approaching or in a chain, when samples come often.
  bool is_fresh(const HeardModule& module, bool near, TimePoint now) const;

  // As of now: on with the motion it had when it was heard.
  robot::Pose centre_pose_W(const HeardModule& module, TimePoint now) const;  // M: the composite centre of mass
  robot::Pose body_pose_W(const HeardModule& module, TimePoint now) const;
  robot::Pose port_pose_W(const HeardModule& module, std::uint32_t port, TimePoint now) const;
  /// Of the composite centre of mass in the frame of a port.
  robot::Pose centre_from_port(const HeardModule& module, std::uint32_t port) const;

 private:
  HeardModule* note(std::uint32_t id, TimePoint at) noexcept;
  void take_states(TimePoint now) noexcept;
  void take_conditions(TimePoint now) noexcept;
  std::span<const double> joints_of(const HeardModule& module) const;

  std::uint32_t own_id_;
  robot::Airframe airframe_;
  std::array<HeardModule, bound> modules_{};  // ourselves first

  std::optional<msg::Heartbeat> radio_beat_;

  bus::Reader<msg::ModuleState> module_states_;
  bus::Reader<msg::JointState> joint_states_;
  bus::Reader<msg::ExternalWrench> external_wrenches_;
  bus::Reader<msg::DockingState> docking_states_;
  bus::Reader<msg::Beacon> beacons_;
  bus::Reader<msg::Heartbeat> heartbeats_;
};

}  // namespace eciton::docking
