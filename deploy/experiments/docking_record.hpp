// What the physics and the services say of one docking, moment by moment: how the two ports come together, and
// how the chain flies in the seconds after.
#pragma once

#include <cstdint>
#include <vector>

#include "deploy/experiments/experiment.hpp"
#include "deploy/experiments/pilot.hpp"

namespace eciton::deploy {

/// Of the docking that goal `goal` asked for, between two sides of modules; asked once every poll.
class DockingRecord {
 public:
  DockingRecord(Simulation& simulation, const Pilot& pilot, std::vector<std::uint32_t> follower_side);

  /// While the docking is under way: true relation of the two ports. Keeps the last seconds.
  void approach(std::uint64_t goal);
  /// It has latched now: times are counted from here.
  void latched() { latched_s_ = simulation_.elapsed_s(); }
  /// Afterwards: the base's true distance from where it was first seen here, the estimated wrench in the new link.
  void assembled();

  /// approach_... and assembled_..., each with the number of the trial beside every sample.
  void write(std::uint32_t trial, Figures& figures) const;

 private:
  struct Approach {
    double time_s, axial_m, radial_m, attitude_rad;
  };
  struct Assembled {
    double time_s, position_error_m, force_N, torque_Nm;
  };

  robot::Pose true_port_pose_W(std::uint32_t module, std::uint32_t port) const;
  bool is_follower(std::uint32_t module) const;

  Simulation& simulation_;
  const Pilot& pilot_;
  std::vector<std::uint32_t> follower_side_;
  std::vector<Approach> approach_;
  std::vector<Assembled> assembled_;
  double latched_s_ = 0;
  bool base_known_ = false;
  robot::Vector3 base_began_W_ = robot::Vector3::Zero();
  bus::Reader<msg::ContactWrench> contact_wrenches_;
};

}  // namespace eciton::deploy
