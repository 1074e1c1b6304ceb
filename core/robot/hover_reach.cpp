// Asks the allocator.
#include "core/robot/hover_reach.hpp"

namespace eciton::robot {

HoverReach::HoverReach(const Airframe& airframe, const HoverReachConfig& config)
    : config_(config), weight_N_(airframe.mass_kg * gravity_m_s2), allocator_(airframe) {}

bool HoverReach::holds(const Matrix3& R_WM, const Vector3& com_offset_B) {
  const Vector3 up_B = R_WM.transpose() * Vector3(0, 0, weight_N_);
  // The allocator takes the branch nearest to where the gimbals are: they come from the weight alone.
  allocator_.set_gimbals(level_);
  const Allocation hover = allocator_.update({up_B, Vector3::Zero()}, com_offset_B);
  if (hover.saturated()) return false;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      allocator_.set_gimbals(hover.outputs());
      const Wrench demand{config_.force_share * up_B, sign * config_.moment_Nm * Vector3::Unit(axis)};
      if (allocator_.update(demand, com_offset_B).saturated()) return false;
    }
  }
  return true;
}

}  // namespace eciton::robot
