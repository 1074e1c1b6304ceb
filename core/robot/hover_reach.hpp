// Which attitudes a module can hover at: its rotors must carry the weight within their gimbals' and thrusts' limits,
// and have something left to steer with.
#pragma once

#include "core/robot/allocation.hpp"

namespace eciton::robot {

struct HoverReachConfig {
  double force_share = 1.1;  // of the weight
  double moment_Nm = 0.3;    // about any axis, either way, on top of it
};

/// Real-time safe after construction; one thread.
class HoverReach {
 public:
  explicit HoverReach(const Airframe& airframe, const HoverReachConfig& config = {});

  bool holds(const Matrix3& R_WM, const Vector3& com_offset_B);

 private:
  HoverReachConfig config_;
  double weight_N_;
  std::array<RotorOutput, rotors_max> level_{};
  Allocator allocator_;
};

}  // namespace eciton::robot
