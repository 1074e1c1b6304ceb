// The wrench observer against its closed form and against a rigid body pushed by a known wrench.
#include "services/estimation/momentum_observer.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace eciton::estimation {
namespace {

using robot::Matrix3;
using robot::Vector3;

void push(MomentumObserver& observer, const MomentumInput& input, double dt_s) {
  ASSERT_TRUE(observer.update(input, dt_s));
}

TEST(MomentumObserverTest, FollowsAForceStepExponentiallyAtAnyTimeStep) {
  // A 2 kg mass hovering, pushed by 3 N from t = 0: v = 1.5 t exactly, and w_ext = 3 (1 - exp(-K t)).
  for (const double dt : {0.002, 0.01, 0.5}) {
    MomentumObserver observer({.force_gain_1_s = 6, .moment_gain_1_s = 6});
    MomentumInput in;
    in.mass_kg = 2;
    in.known_M.force = {0, 0, 2 * 9.81};
    push(observer, in, dt);
    for (int k = 1; k <= 20; ++k) {
      in.v_WM = Vector3(1.5 * k * dt, 0, 0);
      push(observer, in, dt);
      EXPECT_NEAR(observer.wrench_W().force.x(), 3 * (1 - std::exp(-6 * k * dt)), 1e-9);
      EXPECT_NEAR(observer.wrench_W().force.z(), 0, 1e-9);
    }
  }
}

TEST(MomentumObserverTest, TwoStepsByHand) {
  // K dt = 1, so a = 1/e and 1 - a = 0.632121. Turned by 90 degrees about z: the rotors' 1 N along body x is 1 N
  // along world y, and a moment about body x is one about world y.
  MomentumObserver observer({.force_gain_1_s = 10, .moment_gain_1_s = 10});
  MomentumInput in;
  in.mass_kg = 2;
  in.I_M_kg_m2 = Vector3(0.1, 0.2, 0.3).asDiagonal();
  in.R_WM = robot::exp_so3({0, 0, std::acos(0.0)});
  in.known_M = {{1, 0, 19.62}, {0.01, 0, 0}};
  push(observer, in, 0.1);
  // dp/dt = 2 x 0.1 / 0.1 = 2 N along y of which the rotors make 1; dL/dt = 0.1 x 0.05 / 0.1 = 0.05 Nm, they make
  // .01.
  in.v_WM = {0, 0.1, 0};
  in.w_WM_M = {0.05, 0, 0};
  push(observer, in, 0.1);
  EXPECT_NEAR(observer.wrench_W().force.y(), 0.632121, 1e-6);
  EXPECT_NEAR(observer.wrench_W().moment.y(), 0.632121 * 0.04, 1e-6);
  // Then nothing changes any more, so something holds against the rotors: a w + (1 - a) (0 - u).
  push(observer, in, 0.1);
  EXPECT_NEAR(observer.wrench_W().force.y(), 0.367879 * 0.632121 - 0.632121, 1e-6);
  EXPECT_NEAR(observer.wrench_W().moment.y(), 0.367879 * 0.632121 * 0.04 - 0.632121 * 0.01, 1e-6);
  EXPECT_NEAR(observer.wrench_W().force.z(), 0, 1e-9);
}

TEST(MomentumObserverTest, WhatIsNoNumberLeavesItAsItWas) {
  MomentumObserver observer;
  MomentumInput in;
  in.mass_kg = 4;
  in.known_M.force = {1, 0, 4 * 9.81};
  for (int k = 0; k < 100; ++k) push(observer, in, 0.002);
  const robot::Wrench before = observer.wrench_W();
  MomentumInput bad = in;
  bad.v_WM.x() = std::nan("");
  EXPECT_FALSE(observer.update(bad, 0.002));
  bad = in;
  bad.known_M.moment.z() = std::nan("");
  EXPECT_FALSE(observer.update(bad, 0.002));
  EXPECT_FALSE(observer.update(in, std::nan("")));
  EXPECT_EQ(observer.wrench_W().force, before.force);
  push(observer, in, 0.002);
  EXPECT_LT((observer.wrench_W().force - before.force).norm(), 0.1);
}

/// A tumbling body under a wrench it knows of and one it does not, integrated finely.
struct Tumble {
  double mass = 3.9;
  Matrix3 I = Vector3(0.04, 0.14, 0.17).asDiagonal();
  Matrix3 R = Matrix3::Identity();
  Vector3 v = Vector3::Zero(), w = Vector3(0.8, -0.5, 0.6);

  void step(const robot::Wrench& known_M, const robot::Wrench& external_W, double dt) {
    constexpr int parts = 20;
    for (int i = 0; i < parts; ++i) {
      const double h = dt / parts;
      const Matrix3 R_mid = R * robot::exp_so3(w * h / 2);
      v += h * ((R_mid * known_M.force + external_W.force) / mass - Vector3(0, 0, 9.81));
      const auto w_rate = [&](const Vector3& x) -> Vector3 {
        return I.inverse() * (known_M.moment + R_mid.transpose() * external_W.moment - x.cross(I * x));
      };
      const Vector3 w_mid = w + h / 2 * w_rate(w);
      w += h * w_rate(w_mid);
      R = R * robot::exp_so3(w_mid * h);
    }
  }
};

TEST(MomentumObserverTest, FindsTheWorldWrenchOnATumblingBody) {
  Tumble body;
  MomentumObserver observer;
  const robot::Wrench external_W{{1, -2, 0.5}, {0.05, 0.02, -0.04}};
  const double dt = 0.002;
  for (int k = 0; k < 1500; ++k) {
    const robot::Wrench known_M{{1 + std::sin(k * dt), 2, 30}, {0.01 * std::cos(k * dt), 0, 0.02}};
    push(observer, {body.mass, body.I, body.v, body.w, body.R, known_M}, dt);
    body.step(known_M, external_W, dt);
  }
  EXPECT_LT((observer.wrench_W().force - external_W.force).norm(), 0.02);
  // In body axes the moment turns, at about 1 rad/s; the filter lags by 1/K.
  EXPECT_LT((observer.wrench_W().moment - external_W.moment).norm(), 0.02);
}

TEST(MomentumObserverTest, NegativeControlTheGravitySignOfThePaperReadsTwiceTheWeight) {
  MomentumObserver observer;
  MomentumInput in;
  in.mass_kg = 4;
  in.known_M.force = {0, 0, -4 * 9.81};  // what balance would need if g pointed the other way
  for (int k = 0; k < 2000; ++k) push(observer, in, 0.002);
  EXPECT_NEAR(observer.wrench_W().force.z(), 2 * 4 * 9.81, 1e-6);
}

TEST(MomentumObserverTest, AVelocityThatJumpsIsNoWrenchWhenAnnounced) {
  MomentumObserver observer;
  MomentumInput in;
  in.mass_kg = 4;
  in.known_M.force = {0, 0, 4 * 9.81};
  for (int k = 0; k < 10; ++k) push(observer, in, 0.002);
  in.v_WM = {0.5, 0, 0};
  observer.hold();
  for (int k = 0; k < 10; ++k) push(observer, in, 0.002);
  EXPECT_LT(observer.wrench_W().force.norm(), 1e-9);
  in.v_WM = {1, 0, 0};
  push(observer, in, 0.002);
  EXPECT_GT(observer.wrench_W().force.norm(), 10);  // unannounced it is
}

}  // namespace
}  // namespace eciton::estimation
