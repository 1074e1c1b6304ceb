// What acts on a chain, against cases worked out by hand and against the totals that any spread must keep.
#include "core/robot/chain_disturbance.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

namespace eciton::robot {
namespace {

ChainDisturbance of(const std::vector<ChainLoad>& loads, double lever_m = disturbance_lever_m) {
  return {loads.size(), [&](std::size_t k) { return loads[k]; }, lever_m};
}

/// Forces and moments about the world's origin.
Wrench total(const std::vector<ChainLoad>& loads) {
  Wrench sum;
  for (const ChainLoad& one : loads) sum += shift(one.external_W, one.r_W) * one.weight;
  return sum;
}

std::vector<ChainLoad> shares(const std::vector<ChainLoad>& loads, const ChainDisturbance& disturbance) {
  std::vector<ChainLoad> out = loads;
  for (ChainLoad& one : out) one.external_W = disturbance.share(one.r_W);
  return out;
}

TEST(ChainDisturbanceTest, AWindIsTheSameForceOnEach) {
  const std::vector<ChainLoad> loads{{{{4, 0, 0}, Vector3::Zero()}, {0, 0, 1}},
                                     {{{4, 0, 0}, Vector3::Zero()}, {-1, 0, 1}},
                                     {{{4, 0, 0}, Vector3::Zero()}, {-2, 1, 1}}};
  const ChainDisturbance wind = of(loads);
  for (const ChainLoad& one : loads) {
    EXPECT_LT((wind.share(one.r_W).force - Vector3(4, 0, 0)).norm(), 1e-12);
    EXPECT_LT(wind.share(one.r_W).moment.norm(), 1e-12);
  }
}

TEST(ChainDisturbanceTest, ATurningWindOfTwoByHand) {
  // Members at x = +1 and -1 m; 1 N along y on the first, -1 N on the second: a moment of 2 Nm about z. With a lever
  // l, t = 2 / (2 l^2 + 2 1^2) about z: F = t x rho = t along y on the first, M = l^2 t each.
  const std::vector<ChainLoad> loads{{{{0, 1, 0}, Vector3::Zero()}, {1, 0, 0}},
                                     {{{0, -1, 0}, Vector3::Zero()}, {-1, 0, 0}}};
  for (const double lever_m : {0.2, 0.5, 1.0}) {
    const double t = 2 / (2 * lever_m * lever_m + 2);
    const Wrench share = of(loads, lever_m).share(loads[0].r_W);
    EXPECT_LT((share.force - Vector3(0, t, 0)).norm(), 1e-12);
    EXPECT_LT((share.moment - Vector3(0, 0, lever_m * lever_m * t)).norm(), 1e-12);
  }
}

TEST(ChainDisturbanceTest, SharesAddUpToTheLoadsWhateverTheyAre) {
  std::mt19937 rng(3);
  std::normal_distribution<double> n(0, 1);
  const auto draw = [&] { return Vector3(n(rng), n(rng), n(rng)); };
  for (int run = 0; run < 50; ++run) {
    std::vector<ChainLoad> loads(1 + run % 8);
    for (ChainLoad& one : loads) one = {{draw(), draw()}, draw(), 0.2 + 0.1 * (run % 9)};
    const Wrench is = total(shares(loads, of(loads))), wanted = total(loads);
    EXPECT_LT((is.force - wanted.force).norm(), 1e-9);
    EXPECT_LT((is.moment - wanted.moment).norm(), 1e-9);
  }
}

TEST(ChainDisturbanceTest, ContactBetweenMembersIsNoDisturbance) {
  // 3 N and 0.3 Nm through the link at P: on the members about their own r, opposite.
  const Vector3 P(0.4, 0.1, 0), r_1(1, 0, 0), r_2(-0.2, 0.3, 0);
  const Wrench contact_P{{3, -1, 2}, {0.3, 0.1, -0.2}};
  const std::vector<ChainLoad> loads{{shift(-contact_P, P - r_1), r_1}, {shift(contact_P, P - r_2), r_2}};
  for (const ChainLoad& one : loads) {
    EXPECT_LT(of(loads).share(one.r_W).force.norm() + of(loads).share(one.r_W).moment.norm(), 1e-12);
  }
}

TEST(ChainDisturbanceTest, WhoDoesNotCountIsNotLookedAt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<ChainLoad> loads{{{{1, 0, 0}, Vector3::Zero()}, {0, 0, 0}},
                               {{{nan, 0, 0}, Vector3::Zero()}, {nan, 0, 0}, 0}};
  EXPECT_LT((of(loads).share({5, 0, 0}).force - Vector3(1, 0, 0)).norm(), 1e-12);
  loads[0].weight = 0;
  EXPECT_EQ(of(loads).share({5, 0, 0}).force.norm(), 0);
  EXPECT_EQ(of({}).share({5, 0, 0}).force.norm(), 0);
}

}  // namespace
}  // namespace eciton::robot
