// The fail-safe flown on a rigid body: it levels, comes down at its speed and stops its motors on the ground.
#include "core/robot/safe_descent.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/robot/actuator_lag.hpp"

namespace eciton::robot {
namespace {

struct Body {
  Airframe airframe = legion();
  Vector3 p{0, 0, 2}, v = Vector3::Zero(), w = Vector3::Zero();
  Matrix3 R = Matrix3::Identity();
  Vector3 specific_force_B{0, 0, gravity_m_s2};
  Allocator allocator{airframe};
  ActuatorLag lag{airframe};

  void step(const Wrench& demanded_B, double dt) {
    lag.update(allocator.update(demanded_B, Vector3::Zero()).outputs(), dt);
    const Wrench made = lag.wrench_B(Vector3::Zero());
    const bool standing = p.z() <= 0 && v.z() <= 0;
    Vector3 a = R * made.force / airframe.mass_kg - Vector3(0, 0, gravity_m_s2);
    const Vector3 before = v;
    v += a * dt;
    if (standing) v = {0, 0, std::max(0.0, v.z())};
    a = (v - before) / dt;
    specific_force_B = R.transpose() * (a + Vector3(0, 0, gravity_m_s2));
    p += v * dt;
    const Matrix3& I = airframe.I_B_kg_m2;
    if (!standing)
      w += I.inverse() * (made.moment - w.cross(I * w)) * dt;
    else
      w.setZero();
    R = R * exp_so3(w * dt);
  }
};

TEST(SafeDescentTest, LevelsComesDownAndStopsTheMotors) {
  Body body;
  body.R = exp_so3({0.5, -0.4, 1});
  body.v = {0.5, 0, -0.1};
  SafeDescent safe({}, body.airframe.mass_kg, body.airframe.I_B_kg_m2);
  safe.start(SafeManoeuvre::descend, body.R, body.v.z(), {});
  double fastest = 0;
  const double dt = 0.002;
  double t = 0;
  for (; t < 20 && !safe.finished(); t += dt) {
    body.step(safe.update(body.R, body.w, body.specific_force_B, dt), dt);
    fastest = std::min(fastest, body.v.z());
    EXPECT_TRUE(t < 2 || body.R(2, 2) > 0.995) << t;
  }
  EXPECT_TRUE(safe.finished());
  EXPECT_LE(body.p.z(), 0.01);
  EXPECT_GT(t, 3.5);
  EXPECT_GT(fastest, -0.75);
  EXPECT_EQ(safe.update(body.R, body.w, body.specific_force_B, dt).force.norm(), 0);
}

TEST(SafeDescentTest, InAChainItHoldsFirstAndFadesItsFeedForward) {
  Body body;
  body.R = exp_so3({0, 0.6, 0});
  SafeDescent safe({}, body.airframe.mass_kg, body.airframe.I_B_kg_m2);
  const Wrench feed_forward{Vector3(2, 0, 0), Vector3::Zero()};
  safe.start(SafeManoeuvre::hold_hover, body.R, 0, feed_forward);
  const double dt = 0.002;
  const Wrench first = safe.update(body.R, Vector3::Zero(), body.R.transpose() * Vector3(0, 0, gravity_m_s2), dt);
  const Vector3 hover(0, 0, body.airframe.mass_kg * gravity_m_s2);
  EXPECT_LT((body.R * first.force - hover - feed_forward.force).norm(), 0.02);
  EXPECT_LT(first.moment.norm(), 1e-9);
  for (double t = dt; t < 1.9; t += dt) {
    const Wrench w = safe.update(body.R, Vector3::Zero(), body.R.transpose() * Vector3(0, 0, gravity_m_s2), dt);
    EXPECT_NEAR((body.R * w.force - hover).norm(), 2 * std::exp(-t / 0.5), 0.05);
    EXPECT_EQ(safe.phase(), SafePhase::holding);
  }
  for (double t = 0; t < 0.5; t += dt) {
    safe.update(body.R, Vector3::Zero(), body.R.transpose() * Vector3(0, 0, gravity_m_s2), dt);
  }
  EXPECT_EQ(safe.phase(), SafePhase::descending);
}

TEST(SafeDescentTest, AloneItMayHoldItsAttitudeFirstAndLevelsOnlyThen) {
  Body body;
  body.p.z() = 10;
  body.R = exp_so3({0.4, 0.3, 0.5});
  const Matrix3 R_start = body.R;
  SafeDescent safe({}, body.airframe.mass_kg, body.airframe.I_B_kg_m2);
  safe.start(SafeManoeuvre::hold_then_level, body.R, 0, {});
  const double dt = 0.002;
  for (double t = 0; t < 1.9; t += dt) body.step(safe.update(body.R, body.w, body.specific_force_B, dt), dt);
  EXPECT_EQ(safe.phase(), SafePhase::holding);
  EXPECT_LT(log_so3(body.R.transpose() * R_start).norm(), 0.05);
  EXPECT_NEAR(body.p.z(), 10, 0.1);
  for (double t = 0; t < 4; t += dt) body.step(safe.update(body.R, body.w, body.specific_force_B, dt), dt);
  EXPECT_EQ(safe.phase(), SafePhase::descending);
  EXPECT_GT(body.R(2, 2), 0.999);
  EXPECT_NEAR(body.v.z(), -0.5, 0.1);
}

TEST(SafeDescentTest, IdleUntilStartedAndGivesUpInTime) {
  SafeDescentConfig config;
  config.descent_s_max = 1;
  SafeDescent safe(config, 4, Matrix3::Identity());
  EXPECT_EQ(safe.update(Matrix3::Identity(), Vector3::Zero(), Vector3(0, 0, 9), 0.01).force.norm(), 0);
  safe.start(SafeManoeuvre::descend, Matrix3::Identity(), 0, {});
  for (int i = 0; i < 102; ++i) safe.update(Matrix3::Identity(), Vector3::Zero(), Vector3(0, 0, 9), 0.01);
  EXPECT_TRUE(safe.finished());
}

}  // namespace
}  // namespace eciton::robot
