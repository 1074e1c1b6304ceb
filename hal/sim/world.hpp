// The simulated world: modules with rotors, joints, latches and sensors in MuJoCo, stepped at 1 kHz.
// It knows physics and sensors, not DDS. One thread; same seed, same bits. Nothing allocates after the
// constructor.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/robot/airframe.hpp"
#include "core/runtime/plant.hpp"
#include "hal/sim/frames.hpp"
#include "hal/sim/sensor_fault.hpp"
#include "hal/sim/world_config.hpp"

namespace eciton::hal::sim {

/// Where a module really is. M has its origin at the composite centre of mass that the airframe gives
/// for the true joint angles: the point the controllers mean, free of the mass mismatch.
struct TruthPose {
  TimePoint stamp;
  robot::Pose X_WB;
  robot::Vector3 v_WB_m_s;  // of B's origin
  robot::Vector3 p_WM_m;
  robot::Vector3 v_WM_m_s;
  robot::Vector3 w_WM_M_rad_s;
};

/// What really acts in one link, as of the last physics step. F: the peer's female port.
struct TruthContact {
  TimePoint stamp;
  std::uint32_t module_id = 0;  // of the male port
  std::uint32_t port = 0;
  std::uint32_t peer_id = 0;
  std::uint32_t peer_port = 0;
  robot::Vector3 p_W_m;      // docking point
  robot::Wrench wrench_P_W;  // of the module on the peer, about the docking point, world axes
  double gap_m = 0;          // between the two docking points
};

class World : public runtime::Plant {
 public:
  /// Throws BadInput when the modules cannot be: none or too many, an id twice, two in one place, an
  /// airframe of more rotors, joints or ports than a frame holds.
  World(const WorldConfig& config, const robot::Airframe& airframe, const std::vector<ModuleStart>& starts);
  ~World() override;

  TimePoint now() const;
  /// Steps of 1 ms while they end at or before `until`. Real-time safe (no allocation).
  void advance(TimePoint until) override;
  /// The world's clock jumps ahead while its physics stands still: for a host that cannot keep up.
  void skip(Duration duration);

  std::span<const std::uint32_t> modules() const;
  bool has(std::uint32_t module) const;
  const robot::Airframe& airframe() const;

  /// The readings of a module as of now. Asking changes nothing.
  SensorFrame sense(std::uint32_t module) const;
  /// Takes effect from the next step and holds until replaced.
  void actuate(std::uint32_t module, const ActuatorFrame& frame);
  /// The flight board's link watchdog has run out: motors off, joints unpowered, latches as they are.
  void cut(std::uint32_t module);

  TruthPose truth_pose(std::uint32_t module) const;
  /// True joint angles and servo torques.
  JointReading truth_joint(std::uint32_t module, std::size_t joint) const;
  /// Nothing unless the module's male port `port` holds a peer.
  std::optional<TruthContact> truth_contact(std::uint32_t module, std::size_t port) const;
  /// The module's whole mass, with its mismatch.
  double true_mass_kg(std::uint32_t module) const;
  /// Links that really hold.
  int latched_links() const;

  /// Where everything is, for a picture: module by module position and attitude (w, x, y, z) of B in W, joint
  /// angles, then both gimbal angles of each rotor. A Camera reads it.
  std::vector<double> posture() const;

  /// A force and moment on a module besides its rotors, about B's origin, world axes, until replaced.
  void set_external_wrench(std::uint32_t module, const robot::Wrench& wrench_B_W);
  /// Replaces the configuration's constant wind force on every module, N.
  void set_wind(const robot::Vector3& force_W_N);

  /// Breaks a module's sensor, or mends it (SensorFaultKind::none), from its next sample on.
  void break_sensor(std::uint32_t module, SimSensor sensor, const SensorFault& fault);

  /// The physics has diverged: the world stands still from then on and says when and where.
  const std::optional<Error>& fault() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace eciton::hal::sim
