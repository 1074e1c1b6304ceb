// All maths of the step paths, once around: none of it touches the heap.
#include <gtest/gtest.h>

#include <array>

#include "core/robot/actuator_lag.hpp"
#include "core/robot/attitude_filter.hpp"
#include "core/robot/chain_trajectory.hpp"
#include "core/robot/joint_trajectory.hpp"
#include "core/robot/safe_descent.hpp"
#include "services/control/contact_wrench_law.hpp"
#include "services/control/disturbance_feedback.hpp"
#include "services/control/pose_control.hpp"
#include "services/estimation/contact_wrench.hpp"
#include "services/estimation/error_state_filter.hpp"
#include "services/estimation/momentum_observer.hpp"
#include "services/estimation/zeroing.hpp"
#include "tests/allocation_guard/allocation_guard.hpp"

namespace eciton {
namespace {

using robot::Matrix3;
using robot::Vector3;

TEST(StepPathTest, EstimationAllocatesNothing) {
  if (!testing::AllocationGuard::available()) GTEST_SKIP();
  estimation::ErrorStateFilter filter;
  estimation::MomentumObserver observer;
  estimation::Zeroing zeroing(
      {.duration_s = 0.5, .batch_s = 0.1, .samples_min = 100, .quality_N_max = 1e9, .quality_Nm_max = 1e9});
  const robot::Airframe airframe = robot::legion();
  const robot::ActuatorLag lag(airframe);
  std::array<estimation::MemberWrench, 16> members;
  for (estimation::MemberWrench& m : members) m.known = true;
  zeroing.start();
  testing::AllocationGuard guard;
  double sum = 0, zero_N = 0;
  for (int k = 0; k < 300; ++k) {
    filter.update(estimation::ImuSample{k * 2'000'000ll, {0, 0, 9.81}, {0.1, 0, 0}});
    if (k % 10 == 9) {  // 60 ms late
      const std::int64_t stamp_ns = (k > 30 ? k - 30 : k) * 2'000'000ll;
      filter.update(estimation::PoseMeasurement{stamp_ns, {}, 0.001, 0.003});
    }
    const estimation::Estimate e = filter.estimate();
    EXPECT_TRUE(observer.update({4, Matrix3::Identity(), e.v_WB, e.w_WB_B, e.X_WB.R, {}}, 0.002));
    const robot::BiasJacobian jacobian_M = robot::bias_jacobian(airframe, lag.rotors(), Vector3::Zero(), e.X_WB.R);
    zeroing.update(observer.wrench_W(), jacobian_M, e.v_WB, e.w_WB_B, 0.002);
    zero_N += zeroing.bias_M(jacobian_M).force.norm();
    sum += estimation::contact_wrenches(members).members[0].contact_W.force.norm();
  }
  EXPECT_EQ(guard.framework(), 0u) << guard.describe();
  EXPECT_EQ(zeroing.phase(), estimation::ZeroingPhase::done);
  EXPECT_GT(zero_N, 0);
  EXPECT_EQ(sum, 0);
}

TEST(StepPathTest, ControlAllocatesNothing) {
  if (!testing::AllocationGuard::available()) GTEST_SKIP();
  const robot::Airframe airframe = robot::legion();
  control::PoseControl pose_control;
  robot::Allocator allocator(airframe);
  robot::ActuatorLag lag(airframe);
  control::ContactWrenchLaw law;
  control::DisturbanceFeedback feedback;
  robot::AttitudeFilter attitude;
  robot::SafeDescent descent({}, airframe.mass_kg, airframe.I_B_kg_m2);
  std::array<control::ChainMember, 16> chain;
  std::array<robot::PoseReference, 16> references;
  std::array<robot::ScalarMotion, 32> joints;
  const std::array<robot::Pose, 3> waypoints{robot::Pose{}, {Vector3(1, 0, 0), Matrix3::Identity()}, {}};
  descent.start(robot::SafeManoeuvre::hold_then_level, Matrix3::Identity(), 0, {});
  testing::AllocationGuard guard;
  for (int k = 0; k < 100; ++k) {
    const double t = k * 0.002;
    const robot::PoseMotion motion(references[0], waypoints[1], 0, robot::SpeedProfile::trapezoid, {});
    const robot::PoseSpline spline(waypoints, 0, robot::SpeedProfile::quintic, {});
    robot::chain_references(airframe, 7, k % 2 == 0 ? motion.at(t) : spline.at(t), joints, references);
    control::PoseControlInput in;
    in.reference = references[3];
    in.mass_kg = airframe.mass_kg;
    in.I_M_kg_m2 = robot::composite_inertia(airframe, std::array{0.1, 0.2});
    in.feed_forward_W = law.update(chain, 3, {}, 0.01) + feedback.update({}, control::FeedbackPhase::follow, 0.002);
    const robot::Allocation rotors = allocator.update(pose_control.update(in, 0.002), Vector3::Zero());
    lag.update(rotors.outputs(), 0.002);
    attitude.update(Vector3::Zero(), {0, 0, 9.81}, 0.002);
    descent.update(attitude.R_WB(), attitude.w_WB_B(), {0, 0, 9.81}, 0.002);
  }
  EXPECT_EQ(guard.framework(), 0u) << guard.describe();
}

TEST(StepPathTest, JointGoalsAllocateNothingEvenWhenRefused) {
  if (!testing::AllocationGuard::available()) GTEST_SKIP();
  robot::JointTrajectory trajectory(robot::legion());
  std::array<double, 32> goal{};
  testing::AllocationGuard guard;
  trajectory.reset(goal, 7);
  goal[3] = 0.3;
  EXPECT_FALSE(trajectory.go(goal, 0, 0, 0));
  goal[3] = 9;
  const auto fault = trajectory.go(goal, 0, 1, 1);
  char text[128] = "";
  if (fault) fault->describe(text, sizeof text);
  trajectory.stop(2);
  EXPECT_EQ(guard.framework(), 0u) << guard.describe();
  EXPECT_STRNE(text, "");
}

}  // namespace
}  // namespace eciton
