// Samples of a docking.
#include "deploy/experiments/docking_record.hpp"

#include <algorithm>

#include "core/robot/arrays.hpp"
#include "core/robot/kinematics.hpp"
#include "services/docking/port_relation.hpp"

namespace eciton::deploy {
namespace {

constexpr double approach_kept_s = 6;

}  // namespace

DockingRecord::DockingRecord(Simulation& simulation, const Pilot& pilot, std::vector<std::uint32_t> follower_side)
    : simulation_(simulation),
      pilot_(pilot),
      follower_side_(std::move(follower_side)),
      contact_wrenches_(simulation.listener(0).create_reader(topics::contact_wrench)) {}

bool DockingRecord::is_follower(std::uint32_t module) const {
  return std::find(follower_side_.begin(), follower_side_.end(), module) != follower_side_.end();
}

robot::Pose DockingRecord::true_port_pose_W(std::uint32_t module, std::uint32_t port) const {
  const hal::sim::World& world = simulation_.world();
  const robot::Airframe& airframe = world.airframe();
  std::vector<double> joint_rad;
  for (std::size_t k = 0; k < airframe.joints.size(); ++k) {
    joint_rad.push_back(world.truth_joint(module, k).position_rad);
  }
  return world.truth_pose(module).X_WB * robot::port_pose_B(airframe, static_cast<int>(port), joint_rad);
}

void DockingRecord::approach(std::uint64_t goal) {
  for (const std::uint32_t id : follower_side_) {
    const KnownModule* known = pilot_.fleet().find(id);
    if (known == nullptr || !known->docking) continue;
    const msg::DockingState& d = *known->docking;
    if (d.role != msg::DockingRole::follower || d.correlation_id != goal) continue;
    const robot::Pose X_WT = true_port_pose_W(d.peer_id, d.peer_port);
    const robot::Pose X_WF = true_port_pose_W(id, d.port);
    const docking::PortRelation at =
        docking::relation(X_WT.inverse() * X_WF, simulation_.world().airframe().ports[d.peer_port].kind);
    approach_.push_back({simulation_.elapsed_s(), at.gap_m, at.radial_m, at.attitude_rad});
    return;
  }
}

void DockingRecord::assembled() {
  const KnownModule* known = pilot_.fleet().find(follower_side_.front());
  if (known == nullptr || !known->in_chain()) return;
  const robot::Vector3 base_W = simulation_.world().truth_pose(known->view->base_id).p_WM_m;
  if (!base_known_) base_began_W_ = base_W;
  base_known_ = true;
  const auto sample = contact_wrenches_.take_newest();
  if (!sample) return;
  const msg::ContactWrench& w = sample->value;
  for (std::size_t k = 0; k + 1 < w.members.size(); ++k) {
    if (is_follower(w.members[k].module_id) == is_follower(w.members[k + 1].module_id)) continue;
    assembled_.push_back({simulation_.elapsed_s(), (base_W - base_began_W_).norm(),
                          robot::vector(w.members[k].link_force_W_N).norm(),
                          robot::vector(w.members[k].link_moment_W_Nm).norm()});
  }
}

void DockingRecord::write(std::uint32_t trial, Figures& figures) const {
  auto& series = figures.series;
  for (const Approach& a : approach_) {
    if (a.time_s < latched_s_ - approach_kept_s) continue;
    series["approach_trial"].push_back(trial);
    series["approach_time_s"].push_back(a.time_s - latched_s_);
    series["approach_axial_m"].push_back(a.axial_m);
    series["approach_radial_m"].push_back(a.radial_m);
    series["approach_attitude_rad"].push_back(a.attitude_rad);
  }
  for (const Assembled& a : assembled_) {
    series["assembled_trial"].push_back(trial);
    series["assembled_time_s"].push_back(a.time_s - latched_s_);
    series["assembled_position_error_m"].push_back(a.position_error_m);
    series["assembled_contact_force_N_estimated"].push_back(a.force_N);
    series["assembled_contact_torque_Nm_estimated"].push_back(a.torque_Nm);
  }
}

}  // namespace eciton::deploy
