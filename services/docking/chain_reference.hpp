// From where a member of a chain shall be to where the chain's base shall be: a chain is led by its base's
// reference. Through the pose of the base as the member sees it now, so that what their sensors disagree about
// does not move the member off its place.
#pragma once

#include <cmath>

#include "core/robot/frames.hpp"

namespace eciton::docking {

/// A pose that follows measurements, smoothed. Real-time safe.
class SmoothedPose {
 public:
  void start(const robot::Pose& X) { X_ = X; }
  void update(double dt_s, double time_constant_s, const robot::Pose& X) {
    const double share = time_constant_s > 0 ? 1 - std::exp(-dt_s / time_constant_s) : 1;
    X_.p += share * (X.p - X_.p);
    X_.R = X_.R * robot::exp_so3(share * robot::log_so3(X_.R.transpose() * X.R));
  }
  const robot::Pose& pose() const { return X_; }

 private:
  robot::Pose X_;
};

/// A frame that moves; velocities in world axes.
struct MovingPose {
  robot::Pose X_WM;
  robot::Vector3 v_WM = robot::Vector3::Zero();
  robot::Vector3 w_WM = robot::Vector3::Zero();
};

/// Another frame of the same rigid body, at `X_MN`.
inline MovingPose carried_along(const MovingPose& body, const robot::Pose& X_MN) {
  const robot::Vector3 p_MN_W = body.X_WM.R * X_MN.p;
  return {body.X_WM * X_MN, body.v_WM + body.w_WM.cross(p_MN_W), body.w_WM};
}

}  // namespace eciton::docking
