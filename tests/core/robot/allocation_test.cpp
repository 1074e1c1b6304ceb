// Allocation against the rotor convention worked out by hand, and against itself going forward.
#include "core/robot/allocation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace eciton::robot {
namespace {

constexpr double pi = std::numbers::pi;

Vector3 random_vector(std::mt19937& rng, double size) {
  std::uniform_real_distribution<double> u(-size, size);
  const double x = u(rng), y = u(rng), z = u(rng);
  return {x, y, z};
}

TEST(RotorConventionTest, OuterGimbalTiltsAboutXInnerAboutY) {
  EXPECT_TRUE(thrust_vector_B({10, {0, 0}}).isApprox(Vector3(0, 0, 10)));
  EXPECT_TRUE(thrust_vector_B({10, {pi / 2, 0}}).isApprox(Vector3(0, -10, 0)));
  EXPECT_TRUE(thrust_vector_B({10, {0, pi / 2}}).isApprox(Vector3(10, 0, 0)));
  const double phi = 0.4, theta = -0.7;
  const Matrix3 R = (Eigen::AngleAxisd(phi, Vector3::UnitX()) * Eigen::AngleAxisd(theta, Vector3::UnitY())).matrix();
  EXPECT_TRUE(thrust_vector_B({10, {phi, theta}}).isApprox(R * Vector3(0, 0, 10), 1e-14));
}

TEST(RotorConventionTest, BothBranchesMakeTheSameThrustAndTheNearerIsTaken) {
  // theta beyond a quarter turn, reached continuously, stays on its branch ...
  const RotorOutput tilted{8, {0.3, 1.7}};
  const RotorOutput back = rotor_output(thrust_vector_B(tilted), {0.29, 1.65}, 2.0);
  EXPECT_NEAR(back.gimbal_rad[0], 0.3, 1e-12);
  EXPECT_NEAR(back.gimbal_rad[1], 1.7, 1e-12);
  // ... though from rest the principal one would be the outer gimbal turned over.
  const RotorOutput other = rotor_output(thrust_vector_B(tilted), {0.3 - pi, pi - 1.7}, 4.0);
  EXPECT_NEAR(other.gimbal_rad[0], 0.3 - pi, 1e-12);
  EXPECT_NEAR(other.gimbal_rad[1], pi - 1.7, 1e-12);
  EXPECT_TRUE(thrust_vector_B(other).isApprox(thrust_vector_B(tilted), 1e-12));
}

TEST(RotorConventionTest, AThrustTurningPastAQuarterTurnIsFollowedWithoutAFlip) {
  std::array<double, 2> present{0.02, 1.2};
  double principal_jump = 0, principal = 0.02;
  for (double theta = 1.2; theta < 1.9; theta += 0.005) {
    const Vector3 thrust = thrust_vector_B({8, {0.02, theta}});
    const RotorOutput o = rotor_output(thrust, present, 2.0);
    EXPECT_NEAR(o.gimbal_rad[0], 0.02, 1e-9);
    EXPECT_NEAR(o.gimbal_rad[1], theta, 1e-9);
    present = o.gimbal_rad;
    const double phi = std::atan2(-thrust.y(), thrust.z());
    principal_jump = std::max(principal_jump, std::abs(phi - principal));
    principal = phi;
  }
  EXPECT_GT(principal_jump, 3);  // what it would do without the rule
}

TEST(RotorConventionTest, ABranchBeyondTheLimitIsNotTakenEvenIfNearer) {
  const Vector3 thrust = thrust_vector_B({8, {0.5, 1.3}});
  const RotorOutput o = rotor_output(thrust, {0.5 - pi, pi - 1.3}, 2.0);  // present one: phi = -2.64
  EXPECT_NEAR(o.gimbal_rad[0], 0.5, 1e-12);
  EXPECT_NEAR(o.gimbal_rad[1], 1.3, 1e-12);
}

TEST(RotorConventionTest, PhiStaysWhereItIsUndefined) {
  const RotorOutput o = rotor_output({5, 0, 0}, {0.7, 1.5}, 2.0);
  EXPECT_DOUBLE_EQ(o.gimbal_rad[0], 0.7);
  EXPECT_DOUBLE_EQ(o.gimbal_rad[1], pi / 2);
}

TEST(AllocationTest, OneRotorsWrenchIsWhatAPencilSays) {
  Airframe a;
  a.mass_kg = 1;
  a.rotors.push_back({Vector3(0.5, 0, 0), 0.1, 0, 10, 2, 3});
  const Wrench w = rotor_wrench_B(a, std::array{RotorOutput{4, {0, 0}}}, Vector3(0.1, 0, 0));
  EXPECT_TRUE(w.force.isApprox(Vector3(0, 0, 4)));
  EXPECT_TRUE(w.moment.isApprox(Vector3(0, -0.4 * 4, 0.1 * 4)));  // r x f, and drag along f
}

TEST(AllocationTest, ReproducesTheRequestedWrenchWithTheMassCentreMoved) {
  const Airframe a = legion(true);
  Allocator allocator(a);
  std::mt19937 rng(1);
  for (int i = 0; i < 200; ++i) {
    const Vector3 c = random_vector(rng, 0.01);
    const Wrench w{Vector3(0, 0, a.mass_kg * gravity_m_s2) + random_vector(rng, 8), random_vector(rng, 0.6)};
    const Allocation out = allocator.update(w, c);
    EXPECT_FALSE(out.saturated());
    EXPECT_LT((out.achieved_B.force - w.force).norm(), 1e-10);
    EXPECT_LT((out.achieved_B.moment - w.moment).norm(), 1e-10);
  }
}

TEST(AllocationTest, IgnoringTheMassCentreOffsetMakesAFalseMoment) {
  const Airframe a = legion();
  Allocator allocator(a);
  const Vector3 c(0.01, 0, 0);
  const Wrench hover{Vector3(0, 0, a.mass_kg * gravity_m_s2), Vector3::Zero()};
  const Allocation naive = allocator.update(hover, Vector3::Zero());
  EXPECT_NEAR(rotor_wrench_B(a, naive.outputs(), c).moment.y(), 0.01 * hover.force.z(), 1e-9);
}

TEST(AllocationTest, HoverSharesTheWeightOfTheRotors) {
  const Airframe a = legion();
  Allocator allocator(a);
  const Allocation out =
      allocator.update({Vector3(0, 0, a.mass_kg * gravity_m_s2), Vector3::Zero()}, Vector3::Zero());
  double sum = 0;
  for (const RotorOutput& o : out.outputs()) {
    sum += o.thrust_N * std::cos(o.gimbal_rad[0]) * std::cos(o.gimbal_rad[1]);
    EXPECT_NEAR(o.thrust_N, 12.8, 0.4);  // hardware.md: 12.8 N a rotor
  }
  EXPECT_NEAR(sum, a.mass_kg * gravity_m_s2, 1e-9);
}

TEST(AllocationTest, MomentIsKeptAndForceGivesWayWhenThrustRunsOut) {
  const Airframe a = legion();
  Allocator allocator(a);
  const Wrench w{Vector3(0, 0, 60), Vector3(1.5, 0.5, 1)};
  const Allocation out = allocator.update(w, Vector3::Zero());
  EXPECT_TRUE(out.saturated());
  EXPECT_LT(out.force_scale, 1);
  EXPECT_GE(out.force_scale, 0.6);
  EXPECT_DOUBLE_EQ(out.moment_scale, 1);
  EXPECT_LT((out.achieved_B.moment - w.moment).norm(), 1e-9);
  EXPECT_LT((out.achieved_B.force - w.force * out.force_scale).norm(), 1e-9);
  double greatest = 0;
  for (const RotorOutput& o : out.outputs()) greatest = std::max(greatest, o.thrust_N);
  EXPECT_NEAR(greatest, 21, 1e-6);  // no more than needed was given away
}

TEST(AllocationTest, TheMomentGivesWayOnlyWhenTheForceMayNotShrinkFurther) {
  const Airframe a = legion();
  Allocator allocator(a);
  const Wrench w{Vector3(0, 0, 40), Vector3(12, 0, 0)};
  const Allocation out = allocator.update(w, Vector3::Zero());
  EXPECT_DOUBLE_EQ(out.force_scale, 0.6);
  EXPECT_GT(out.moment_scale, 0);
  EXPECT_LT(out.moment_scale, 1);
  for (const RotorOutput& o : out.outputs()) EXPECT_LE(o.thrust_N, 21 + 1e-9);
}

TEST(AllocationTest, LimitsHoldAndAreReportedForAnyDemand) {
  const Airframe a = legion();
  Allocator allocator(a);
  std::mt19937 rng(3);
  for (int i = 0; i < 500; ++i) {
    const Wrench w{random_vector(rng, 150), random_vector(rng, 30)};
    const Allocation out = allocator.update(w, random_vector(rng, 0.02));
    for (const RotorOutput& o : out.outputs()) {
      EXPECT_GE(o.thrust_N, 1.0);
      EXPECT_LE(o.thrust_N, 21.0);
      EXPECT_LE(std::abs(o.gimbal_rad[0]), 2.0);
      EXPECT_LE(std::abs(o.gimbal_rad[1]), 2.0);
    }
    const bool reproduced =
        (out.achieved_B.force - w.force).norm() + (out.achieved_B.moment - w.moment).norm() < 1e-9;
    EXPECT_NE(out.saturated(), reproduced);
  }
}

TEST(AllocationTest, PitchingOverNeverFlipsAGimbal) {
  // Up to 1.3 rad with a rolling moment on top; beyond 1.37 rad the outer gimbal itself comes to its limit.
  const Airframe a = legion();
  Allocator allocator(a);
  std::array<RotorOutput, 3> before{};
  double jump = 0;
  for (int i = 0; i <= 1300; ++i) {
    const Matrix3 R = Eigen::AngleAxisd(i * 1e-3, Vector3::UnitY()).toRotationMatrix();
    const Wrench w{R.transpose() * Vector3(0, 0, a.mass_kg * gravity_m_s2), Vector3(0.1 * std::sin(i * .02), 0, 0)};
    const Allocation out = allocator.update(w, Vector3::Zero());
    EXPECT_FALSE(out.saturated());
    for (std::size_t k = 0; k < 3; ++k) {
      if (i > 0) jump = std::max(jump, std::abs(out.rotors[k].gimbal_rad[0] - before[k].gimbal_rad[0]));
      before[k] = out.rotors[k];
    }
  }
  EXPECT_LT(jump, 0.1);
}

/// The least error of the moment that any setting of the rotors within their limits makes, by trying: from many
/// starts, one number after another up and down by steps that shrink. Knows nothing of the allocator.
double least_moment_error(const Airframe& a, const Vector3& moment_B, std::mt19937& rng) {
  std::uniform_real_distribution<double> u(0, 1);
  const auto error = [&](const std::array<double, 9>& x) {
    std::array<RotorOutput, 3> rotors;
    for (std::size_t k = 0; k < 3; ++k) {
      rotors[k] = {1 + 20 * x[3 * k], {4 * x[3 * k + 1] - 2, 4 * x[3 * k + 2] - 2}};
    }
    return (rotor_wrench_B(a, rotors, Vector3::Zero()).moment - moment_B).norm();
  };
  double best = 1e9;
  for (int start = 0; start < 12; ++start) {
    std::array<double, 9> x;
    for (double& v : x) v = u(rng);
    double now = error(x);
    for (double step = 0.3; step > 1e-3; step *= 0.8) {
      for (double& v : x) {
        for (const double by : {step, -step}) {
          const double before = v;
          v = std::clamp(v + by, 0.0, 1.0);
          const double then = error(x);
          if (then < now) {
            now = then;
          } else {
            v = before;
          }
        }
      }
    }
    best = std::min(best, now);
  }
  return best;
}

/// Hovering tilted a little, then asked for more than there is.
struct Demand {
  Wrench hover, too_much;
};
Demand draw(const Airframe& a, std::mt19937& rng, double force_N, double moment_Nm) {
  const Matrix3 R = exp_so3(random_vector(rng, 0.4));
  const Vector3 up = R.transpose() * Vector3(0, 0, a.mass_kg * gravity_m_s2);
  const Vector3 f = random_vector(rng, force_N), m = random_vector(rng, moment_Nm);
  return {{up, Vector3::Zero()}, {up + f, m}};
}

TEST(AllocationTest, TheMomentIsKeptWhateverForceIsAskedFor) {
  const Airframe a = legion();
  std::mt19937 rng(5);
  int saturated = 0, kept = 0;
  for (int i = 0; i < 2000; ++i) {
    const Demand d = draw(a, rng, 60, 1.5);
    Allocator allocator(a);
    allocator.update(d.hover, Vector3::Zero());
    const Allocation out = allocator.update(d.too_much, Vector3::Zero());
    if (!out.saturated()) continue;
    ++saturated;
    if ((out.achieved_B.moment - d.too_much.moment).norm() < 0.02 * d.too_much.moment.norm()) ++kept;
    for (const RotorOutput& o : out.outputs()) {
      EXPECT_GE(o.thrust_N, 1.0);
      EXPECT_LE(o.thrust_N, 21.0);
      EXPECT_LE(std::abs(o.gimbal_rad[0]), 2.0);
      EXPECT_LE(std::abs(o.gimbal_rad[1]), 2.0);
    }
  }
  EXPECT_GT(saturated, 1000);
  EXPECT_GE(kept, saturated * 0.998);
}

TEST(AllocationTest, NoSettingOfTheRotorsKeepsMuchMoreOfTheMoment) {
  const Airframe a = legion();
  std::mt19937 rng(6);
  int compared = 0, worse = 0;
  for (int i = 0; i < 60; ++i) {
    const Demand d = draw(a, rng, 40, 3);
    Allocator allocator(a);
    allocator.update(d.hover, Vector3::Zero());
    const Allocation out = allocator.update(d.too_much, Vector3::Zero());
    // Where the moment is scaled down some force is kept on purpose: no free fall.
    if (!out.saturated() || out.moment_scale < 1) continue;
    ++compared;
    const double size = d.too_much.moment.norm();
    const double error = (out.achieved_B.moment - d.too_much.moment).norm();
    if (error > least_moment_error(a, d.too_much.moment, rng) + 0.05 * size) ++worse;
  }
  EXPECT_GT(compared, 20);
  EXPECT_LE(worse, 1);
}

TEST(AllocationTest, ADemandThatGrowsSlowlyMovesTheRotorsSlowlyAndTurnsAGimbalOverOnceAtTheMost) {
  // Where a thrust leaves the limits of one branch the gimbals go to the other, half a turn away; never back and
  // forth.
  const Airframe a = legion();
  std::mt19937 rng(7);
  int runs_without = 0;
  for (int i = 0; i < 20; ++i) {
    const Demand d = draw(a, rng, 40, 2);
    Allocator allocator(a);
    std::array<RotorOutput, 3> before{};
    std::array<int, 3> turned_over{};
    for (int k = 0; k <= 4000; ++k) {
      const double s = k / 4000.0;
      const Allocation out = allocator.update(d.hover + (d.too_much - d.hover) * s, Vector3::Zero());
      for (std::size_t r = 0; r < 3; ++r) {
        const RotorOutput& now = out.rotors[r];
        if (k > 0) {
          const double by_rad = std::max(std::abs(now.gimbal_rad[0] - before[r].gimbal_rad[0]),
                                         std::abs(now.gimbal_rad[1] - before[r].gimbal_rad[1]));
          turned_over[r] += by_rad > 0.3 ? 1 : 0;
        }
        before[r] = now;
      }
    }
    for (const int times : turned_over) EXPECT_LE(times, 1) << i;
    runs_without += turned_over == std::array<int, 3>{} ? 1 : 0;
  }
  EXPECT_GE(runs_without, 18);
}

TEST(AllocationTest, BetweenTwoBranchesItStaysOnTheOneItIsOn) {
  // A thrust that trembles about the middle between the two: gimbals follow, none turns over.
  std::mt19937 rng(8);
  std::array<double, 2> present{0.9, 1.5};
  const Vector3 about = thrust_vector_B({8, {0.9, 1.55}});
  for (int k = 0; k < 1000; ++k) {
    const RotorOutput o = rotor_output(about + random_vector(rng, 0.3), present, 2.0);
    EXPECT_LT(std::abs(o.gimbal_rad[1] - present[1]), 0.3);
    present = o.gimbal_rad;
    EXPECT_LT(std::abs(present[1] - 1.55), 0.3);
  }
}

TEST(AllocationTest, FixedRotorsReproduceWhatTheyCan) {
  Airframe a;
  a.mass_kg = 1;
  const double d = 0.1;
  const double spin[] = {1, -1, 1, -1};
  const Vector3 at[] = {{d, -d, 0}, {-d, -d, 0}, {-d, d, 0}, {d, d, 0}};
  for (int k = 0; k < 4; ++k) a.rotors.push_back({at[k], spin[k] * 0.02, 0, 10, 0, 0});
  Allocator allocator(a);
  const Allocation out = allocator.update({Vector3(1, 0, 9.81), Vector3(0.1, -0.2, 0.03)}, Vector3::Zero());
  EXPECT_NEAR(out.achieved_B.force.z(), 9.81, 1e-9);
  EXPECT_NEAR(out.achieved_B.force.x(), 0, 1e-12);  // cannot be made without tilting
  EXPECT_LT((out.achieved_B.moment - Vector3(0.1, -0.2, 0.03)).norm(), 1e-9);
  for (const RotorOutput& o : out.outputs()) EXPECT_EQ(o.gimbal_rad, (std::array<double, 2>{0, 0}));
}

}  // namespace
}  // namespace eciton::robot
