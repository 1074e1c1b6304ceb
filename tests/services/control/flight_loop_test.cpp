// Pose control, allocation and actuator lags closed around a rigid body: it hovers, tracks and holds
// against a push, with both sets of gains.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/services/control/rigid_module.hpp"

namespace eciton::control {
namespace {

using robot::PoseReference;

struct Result {
  double mean_m = 0, max_m = 0, mean_rad = 0, end_m = 0;
  bool saturated = false;
};

/// Control at 500 Hz, the plant at 1 kHz.
Result fly(RigidModule& module, const PoseGains& gains, double duration_s,
           const std::function<PoseReference(double)>& reference, const Wrench& external_W = {}) {
  PoseControlConfig config;
  config.gains = gains;
  PoseControl control(config);
  robot::Allocator allocator(module.airframe);
  robot::Allocation rotors;
  Result out;
  int counted = 0;
  for (int k = 0; k < static_cast<int>(duration_s * 1000); ++k) {
    const double t = k * 1e-3;
    if (k % 2 == 0) {
      PoseControlInput in;
      in.state = module.motion();
      in.reference = reference(t);
      in.mass_kg = module.airframe.mass_kg;
      in.I_M_kg_m2 = module.airframe.I_B_kg_m2;
      in.force_saturated = in.moment_saturated = rotors.saturated();
      rotors = allocator.update(control.update(in, 0.002), Vector3::Zero());
      out.saturated = out.saturated || rotors.saturated();
      out.end_m = (in.reference.p_WM - in.state.p_WM).norm();
      if (t > 1) {
        out.mean_m += out.end_m;
        out.max_m = std::max(out.max_m, out.end_m);
        out.mean_rad += robot::log_so3(in.state.R_WM.transpose() * in.reference.R_WM).norm();
        ++counted;
      }
    }
    module.step(rotors.outputs(), external_W);
  }
  out.mean_m /= counted;
  out.mean_rad /= counted;
  return out;
}

/// The figure of eight of the paper's Fig. S1, run up smoothly to 0.8 m/s while the attitude moves too.
PoseReference eight(double t) {
  const auto pose = [](double at) {
    constexpr double speed = 0.47, run_up_s = 3;  // 0.47 rad/s: 0.8 m/s at the fastest point
    const double u = at < run_up_s ? speed * at * at / (2 * run_up_s) : speed * (at - run_up_s / 2);
    return robot::Pose{Vector3(std::sin(u), 0.6 * std::sin(2 * u), 1.5 + 0.3 * std::sin(u)),
                       robot::exp_so3({0, 0, 0.5 * std::sin(u)}) * robot::exp_so3({0, 0.6 * std::sin(2 * u), 0}) *
                           robot::exp_so3({0.6 * std::sin(u), 0, 0})};
  };
  constexpr double h = 1e-4;
  const auto w = [&](double at) -> Vector3 {
    return robot::log_so3(pose(at - h).R.transpose() * pose(at + h).R) / (2 * h);
  };
  const robot::Pose now = pose(t);
  return {
      now.p, (pose(t + h).p - pose(t - h).p) / (2 * h), (pose(t + h).p - 2 * now.p + pose(t - h).p) / (h * h), now.R,
      w(t),  (w(t + 1e-3) - w(t - 1e-3)) / 2e-3};
}

PoseReference hover(double) {
  PoseReference r;
  r.p_WM = {0, 0, 1.5};
  return r;
}

class FlightLoopTest : public testing::TestWithParam<bool> {
 protected:
  PoseGains gains() const { return GetParam() ? gains_assembled() : gains_free(); }
};
INSTANTIATE_TEST_SUITE_P(Gains, FlightLoopTest, testing::Values(true, false),
                         [](const auto& parameter) { return parameter.param ? "Assembled" : "Free"; });

TEST_P(FlightLoopTest, HoversFromAnOffsetStart) {
  RigidModule module;
  module.set({0.2, -0.1, 1.4}, robot::exp_so3({0.15, -0.1, 0.3}));
  const Result r = fly(module, gains(), 15, hover);
  EXPECT_LT(r.end_m, 0.01);
  EXPECT_LT(module.motion().v_WM.norm() + module.motion().w_WM_M.norm(), 0.01);
}

TEST_P(FlightLoopTest, TracksAFigureOfEightAtEightTenthsOfAMetrePerSecond) {
  RigidModule module;
  module.set({0, 0, 1.5}, Matrix3::Identity());
  const Result r = fly(module, gains(), 15, eight);
  EXPECT_LT(r.mean_m, 0.035);  // prototypes: 0.028 m, nearly all of it the actuators' lag
  EXPECT_LT(r.mean_rad, 0.1);
  EXPECT_FALSE(r.saturated);
}

TEST_P(FlightLoopTest, WithoutLagsTheFeedForwardLeavesMillimetres) {
  RigidModule module({.thrust_time_constant_s = 0, .gimbal_time_constant_s = 0});
  robot::Airframe quick = robot::legion();
  for (robot::RotorGeometry& rotor : quick.rotors) rotor.gimbal_rate_rad_s_max = 1e9;
  module.actuators = robot::ActuatorLag(quick, {0, 0});
  module.set({0, 0, 1.5}, Matrix3::Identity());
  EXPECT_LT(fly(module, gains(), 15, eight).mean_m, 0.002);
}

TEST_P(FlightLoopTest, TheIntegralTakesUpASteadyPush) {
  RigidModule module;
  module.set({0, 0, 1.5}, Matrix3::Identity());
  const Result r = fly(module, gains(), 30, hover, {{3, -2, 1}, {0.1, 0, 0.05}});
  EXPECT_LT(r.end_m, 0.01);
  EXPECT_GT(r.max_m, 0.02);
}

TEST(FlightLoopControlTest, NegativeControlWithoutDampingItDoesNotHover) {
  RigidModule module;
  module.set({0.2, 0, 1.5}, Matrix3::Identity());
  PoseGains gains = gains_free();
  gains.kd_1_s.setZero();
  EXPECT_GT(fly(module, gains, 10, hover).max_m, 0.2);
}

}  // namespace
}  // namespace eciton::control
