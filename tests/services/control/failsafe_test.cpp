// Control's fail-safe flown on the tests' plant: state lost in mid-air, IMU left.
#include "services/control/failsafe.hpp"

#include <gtest/gtest.h>

#include "tests/services/control/rigid_module.hpp"

namespace eciton::control {
namespace {

using robot::SafePhase;

/// Flies on the fail-safe alone for a while; the IMU is exact.
void fly(RigidModule& module, Failsafe& failsafe, double duration_s, bool with_imu = true) {
  robot::Allocator allocator(module.airframe);
  robot::Allocation rotors;
  for (int k = 0; k < static_cast<int>(duration_s * 1000); ++k) {
    if (k % 2 == 0) {
      const ModuleMotion m = module.motion();
      const Vector3 force_B = module.actuators.wrench_B(Vector3::Zero()).force;
      if (with_imu) failsafe.imu(m.w_WM_M, force_B / module.airframe.mass_kg, 0.002);
      rotors = allocator.update(failsafe.update(0.002), Vector3::Zero());
    }
    module.step(rotors.outputs(), {});
  }
}

TEST(FailsafeTest, HoldsItsAttitudeThenLevelsAndDescendsAtItsSpeed) {
  RigidModule module;
  module.set({0, 0, 5}, robot::exp_so3({0.3, 0.2, 0.5}));
  Failsafe failsafe({}, module.airframe.mass_kg, module.airframe.I_B_kg_m2);
  failsafe.state(module.motion().R_WM, 0);
  failsafe.start(false, {});
  fly(module, failsafe, 1.9);
  EXPECT_EQ(failsafe.phase(), SafePhase::holding);
  EXPECT_NEAR(module.motion().p_WM.z(), 5, 0.1);
  EXPECT_LT(robot::log_so3(module.motion().R_WM.transpose() * robot::exp_so3({0.3, 0.2, 0.5})).norm(), 0.05);
  fly(module, failsafe, 4);
  EXPECT_EQ(failsafe.phase(), SafePhase::descending);
  EXPECT_GT(module.motion().R_WM(2, 2), 0.999);
  EXPECT_NEAR(module.motion().v_WM.z(), -0.5, 0.1);
}

TEST(FailsafeTest, InAChainItDescendsInItsAttitude) {
  RigidModule module;
  const Matrix3 R = robot::exp_so3({0, 0.5, 0});
  module.set({0, 0, 5}, R);
  Failsafe failsafe({}, module.airframe.mass_kg, module.airframe.I_B_kg_m2);
  failsafe.state(R, 0);
  failsafe.start(true, {});
  fly(module, failsafe, 5);
  EXPECT_EQ(failsafe.phase(), SafePhase::descending);
  EXPECT_LT(robot::log_so3(module.motion().R_WM.transpose() * R).norm(), 0.05);
  EXPECT_LT(module.motion().v_WM.z(), -0.3);
}

TEST(FailsafeTest, WithoutAnImuItCarriesTheWeightAndEnds) {
  FailsafeConfig config;
  config.descent.descent_s_max = 5;
  RigidModule module;
  module.set({0, 0, 5}, Matrix3::Identity());
  Failsafe failsafe(config, module.airframe.mass_kg, module.airframe.I_B_kg_m2);
  failsafe.state(Matrix3::Identity(), 0);
  failsafe.start(false, {});
  fly(module, failsafe, 1.9, false);
  EXPECT_TRUE(failsafe.imu_missing());
  EXPECT_NEAR(module.motion().p_WM.z(), 5, 0.3);
  fly(module, failsafe, 6, false);
  EXPECT_TRUE(failsafe.finished());
}

}  // namespace
}  // namespace eciton::control
