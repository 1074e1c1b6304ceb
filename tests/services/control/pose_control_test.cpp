// Pose control against (4) and (5) by hand, and its guards.
#include "services/control/pose_control.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace eciton::control {
namespace {

PoseControlInput at_rest() {
  PoseControlInput in;
  in.mass_kg = 2;
  in.I_M_kg_m2 = Vector3(0.1, 0.2, 0.3).asDiagonal();
  return in;
}

TEST(PoseControlTest, AtTheReferenceItCarriesTheWeightInBodyAxes) {
  PoseControl control;
  PoseControlInput in = at_rest();
  in.state.R_WM = in.reference.R_WM = robot::exp_so3({0, std::numbers::pi / 2, 0});
  const Wrench w = control.update(in, 0);
  EXPECT_LT((w.force - Vector3(-2 * 9.81, 0, 0)).norm(), 1e-12);  // pitched by a quarter turn: up is body -x
  EXPECT_LT(w.moment.norm(), 1e-12);
}

TEST(PoseControlTest, EveryTermOfTheForceIsWhereEquationFourPutsIt) {
  PoseControlConfig config;
  config.gains = {{1, 2, 3}, {0.1, 0.2, 0.3}, {4, 5, 6}, {7, 8, 9}, {0, 0, 0}, {1, 1, 1}};
  PoseControl control(config);
  PoseControlInput in = at_rest();
  in.reference.p_WM = {0.1, 0.2, 0.3};
  in.reference.v_WM = {0.01, 0, -0.02};
  in.reference.a_WM = {0, 0.5, 0};
  in.feed_forward_W.force = {1, 0, 0};
  const Wrench w = control.update(in, 0.5);
  const Vector3 expected(2 * (0.1 + 0.1 * 0.1 * 0.5 + 4 * 0.01) + 1, 2 * (0.4 + 0.2 * 0.2 * 0.5 + 0.5),
                         2 * (0.9 + 0.3 * 0.3 * 0.5 - 6 * 0.02 + 9.81));
  EXPECT_LT((w.force - expected).norm(), 1e-12);
}

TEST(PoseControlTest, EveryTermOfTheMomentIsWhereEquationFivePutsIt) {
  PoseControlConfig config;
  config.gains = {{1, 1, 1}, {0, 0, 0}, {1, 1, 1}, {7, 8, 9}, {0.5, 0, 0}, {1, 2, 3}};
  PoseControl control(config);
  PoseControlInput in = at_rest();
  in.state.w_WM_M = {0, 0.4, 0.5};
  in.reference.R_WM = robot::exp_so3({0.2, 0, 0});
  in.reference.w_WM_M = {0.3, 0, 0};
  in.reference.alpha_WM_M = {0.6, 0, 0};
  in.feed_forward_W.moment = {0, 0, 0.7};
  const Wrench w = control.update(in, 0.1);
  // alpha_ff = 0.6 x - w x w_d, with w_d = 0.3 x (turning by 0.2 about x leaves it): w x w_d = (0, .15, -.12).
  const Vector3 alpha(7 * 0.2 + 0.5 * 0.2 * 0.1 + 1 * 0.3 + 0.6, 2 * -0.4 - 0.15, 3 * -0.5 + 0.12);
  // w x I w = (0.4 * 0.3 * 0.5 - 0.5 * 0.2 * 0.4, 0, 0) = (0.02, 0, 0)
  EXPECT_LT((w.moment - Vector3(0.1 * alpha.x() + 0.02, 0.2 * alpha.y(), 0.3 * alpha.z() + 0.7)).norm(), 1e-12);
}

TEST(PoseControlTest, IntegralsStopAtTheirClampAndWhileSaturated) {
  PoseControl control;
  PoseControlInput in = at_rest();
  in.reference.p_WM = {0.5, 0, 0};
  for (int k = 0; k < 100; ++k) control.update(in, 0.1);
  EXPECT_DOUBLE_EQ(control.integral_m_s2().x(), 3);
  control.reset();
  in.force_saturated = true;
  for (int k = 0; k < 100; ++k) control.update(in, 0.1);
  EXPECT_DOUBLE_EQ(control.integral_m_s2().x(), 0);
  control.set_integrals({2, 0, 0}, Vector3::Zero());
  in.reference.p_WM = {-0.5, 0, 0};  // back towards zero it may go
  control.update(in, 0.1);
  EXPECT_NEAR(control.integral_m_s2().x(), 1.9, 1e-12);
}

TEST(PoseControlTest, ChangingGainsDoesNotStepTheOutput) {
  PoseControl control;
  PoseControlInput in = at_rest();
  in.reference.p_WM = {0.2, -0.1, 0.1};
  in.reference.R_WM = robot::exp_so3({0.1, 0.1, -0.1});
  for (int k = 0; k < 500; ++k) control.update(in, 0.002);
  Wrench before = control.update(in, 0.002);
  const Wrench start = before;
  control.set_gains(gains_assembled());
  double step = 0;
  for (int k = 0; k < 300; ++k) {
    const Wrench now = control.update(in, 0.002);
    step = std::max(step, (now.force - before.force).norm() + (now.moment - before.moment).norm());
    before = now;
  }
  EXPECT_LT(step, 0.05);
  EXPECT_GT((before.force - start.force).norm(), 3);  // at once it would have stepped by this
  EXPECT_EQ(control.gains().kp_1_s2, gains_assembled().kp_1_s2);
}

TEST(PoseControlTest, AFarGoalAsksForNoMoreThanANearOne) {
  PoseControl control;
  PoseControlInput in = at_rest();
  in.reference.p_WM = {100, 0, 0};
  // An error of 1 m counts, and of that what level rotors can give.
  EXPECT_NEAR(control.update(in, 0).force.x(), 2 * 9, 1e-9);
  in.reference.p_WM = {0.4, 0, 0};
  EXPECT_NEAR(control.update(in, 0).force.x(), 2 * 20 * 0.4, 1e-9);
}

}  // namespace
}  // namespace eciton::control
