// Contact wrenches against a case by hand and against a dense least-squares solve of (9).
#include "services/estimation/contact_wrench.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace eciton::estimation {
namespace {

using robot::Matrix6;
using robot::Vector3;
using robot::Vector6;
using robot::Wrench;

Vector6 stacked(const Wrench& w) {
  Vector6 out;
  out << w.force, w.moment;
  return out;
}
double size(const Wrench& w) { return stacked(w).norm(); }

Matrix6 X(const Vector3& a) {
  Matrix6 out = Matrix6::Identity();
  out.bottomLeftCorner<3, 3>() = robot::skew(a);
  return out;
}

/// A bent chain with known contact wrenches at its links and a common wind; what its members would feel.
struct Chain {
  std::vector<MemberWrench> members;
  std::vector<Wrench> contacts;  // of i on i+1, about P_i

  Chain(std::size_t n, unsigned seed, const Wrench& common) : members(n), contacts(n - 1) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto v = [&](double s) {
      const double x = u(rng), y = u(rng), z = u(rng);
      return Vector3(s * x, s * y, s * z);
    };
    Vector3 mean = Vector3::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      members[i].known = true;
      members[i].r_W = Vector3(-0.8 * static_cast<double>(i), 0, 1) + v(0.2);
      mean += members[i].r_W / static_cast<double>(n);
    }
    for (std::size_t i = 0; i + 1 < n; ++i) {
      contacts[i] = {v(3), v(0.4)};
      const Vector3 p = (members[i].r_W + members[i + 1].r_W) / 2 + v(0.05);
      members[i].port_to_next_W = members[i + 1].port_to_last_W = p;
    }
    for (std::size_t i = 0; i < n; ++i) {
      Wrench& W = members[i].external_W;
      W = common;  // the same force and moment on each, at its own r
      if (i > 0) W += robot::shift(contacts[i - 1], members[i].port_to_last_W - members[i].r_W);
      if (i + 1 < n) W -= robot::shift(contacts[i], members[i].port_to_next_W - members[i].r_W);
    }
  }
};

TEST(ContactWrenchTest, TwoMembersPushingInAWindByHand) {
  // Module 0 at x = 0.8 pushes module 1 at x = 0 with 3 N towards -x, through P at (0.4, 0.1): a lever of
  // 0.1 m. A wind of 4 N along y acts on both.
  std::vector<MemberWrench> m(2);
  m[0].known = m[1].known = true;
  m[0].r_W = {0.8, 0, 0};
  m[0].port_to_next_W = m[1].port_to_last_W = {0.4, 0.1, 0};
  m[0].external_W = {{3, 4, 0}, {0, 0, -0.3}};  // (P - r0) x (3,0,0) = (-.4,.1,0) x (3,0,0) = (0,0,-.3)
  m[1].external_W = {{-3, 4, 0}, {0, 0, 0.3}};  // (.4,.1,0) x (-3,0,0) = (0,0,.3)
  const ContactWrenches out = contact_wrenches(m);
  EXPECT_TRUE(out.complete);
  EXPECT_EQ(out.fresh, 2u);
  EXPECT_LT(size(out.common_W - Wrench{{0, 4, 0}, {0, 0, 0}}), 1e-12);
  EXPECT_LT(size(out.members[0].d_W - Wrench{{3, 0, 0}, {0, 0, -0.3}}), 1e-12);
  EXPECT_LT(size(out.members[0].contact_W - Wrench{{-3, 0, 0}, {0, 0, 0}}), 1e-12);
  EXPECT_EQ(size(out.members[1].contact_W), 0);
}

TEST(ContactWrenchTest, EqualsTheDenseLeastSquaresSolutionAndTheTruth) {
  for (const std::size_t n : {2u, 3u, 5u, 8u, 16u}) {
    const Chain chain(n, static_cast<unsigned>(n), {{1, 4, -0.5}, {0.02, -0.05, 0.1}});
    const ContactWrenches out = contact_wrenches(chain.members);
    const auto rows = static_cast<Eigen::Index>(6 * n);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, rows - 6);
    Eigen::VectorXd d(rows);
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = static_cast<Eigen::Index>(6 * i);
      const MemberWrench& m = chain.members[i];
      d.segment<6>(row) = stacked(out.members[i].d_W);
      if (i > 0) A.block<6, 6>(row, row - 6) = X(chain.members[i - 1].port_to_next_W - m.r_W);
      if (i + 1 < n) A.block<6, 6>(row, row) = -X(m.port_to_next_W - m.r_W);
    }
    const Eigen::VectorXd c = A.colPivHouseholderQr().solve(d);
    EXPECT_LT((A * c - d).norm(), 1e-11) << n;  // with the consistent D the system is solvable exactly
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const Vector6 running = stacked(out.members[i].contact_W);
      EXPECT_LT((running - c.segment<6>(static_cast<Eigen::Index>(6 * i))).norm(), 1e-11) << n;
      EXPECT_LT((running - stacked(chain.contacts[i])).norm(), 1e-11) << n;
    }
  }
}

TEST(ContactWrenchTest, NegativeControlTheLiteralMeanOfMomentsIsOff) {
  const Chain chain(5, 9, {});
  Vector3 literal = Vector3::Zero();
  for (const MemberWrench& m : chain.members) literal += m.external_W.moment / 5;
  EXPECT_GT((literal - contact_wrenches(chain.members).common_W.moment).norm(), 0.02);
}

TEST(ContactWrenchTest, ASilentMembersShareFadesAndTheRestStillAddsUpToNothing) {
  Chain chain(4, 3, {{0, 4, 0}, {0, 0, 0}});
  for (const double age : {0.0, 0.5, 0.65, 0.9, 5.0}) {
    chain.members[1].age_s = age;
    const ContactWrenches out = contact_wrenches(chain.members);
    Wrench sum;
    for (std::size_t i = 0; i < 4; ++i) {
      sum += robot::shift(out.members[i].d_W, chain.members[i].r_W - out.mean_r_W);
    }
    EXPECT_LT(size(sum), 1e-12) << age;
    EXPECT_EQ(out.fresh, age < 0.3 ? 4u : 3u);
    if (age > 1) {
      EXPECT_EQ(size(out.members[1].d_W), 0);
    }
  }
}

TEST(ContactWrenchTest, WhenAllPeersAreGoneAModuleFeelsNoContact) {
  Chain chain(3, 3, {{0, 4, 0}, {0, 0, 0}});
  chain.members[0].age_s = chain.members[2].age_s = 2;
  const ContactWrenches out = contact_wrenches(chain.members);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(size(out.members[i].d_W) + size(out.members[i].contact_W), 1e-12);
}

TEST(ContactWrenchTest, AMemberNeverHeardOfMakesItIncomplete) {
  Chain chain(3, 3, {});
  chain.members[2].known = false;
  const ContactWrenches out = contact_wrenches(chain.members);
  EXPECT_FALSE(out.complete);
  EXPECT_EQ(size(out.members[0].contact_W), 0);
  EXPECT_FALSE(contact_wrenches({}).complete);
}

TEST(ContactWrenchTest, AloneThereIsNoContact) {
  std::vector<MemberWrench> one(1);
  one[0].known = true;
  one[0].external_W = {{1, 2, 3}, {0.1, 0.2, 0.3}};
  const ContactWrenches out = contact_wrenches(one);
  EXPECT_LT(size(out.members[0].d_W), 1e-12);
  EXPECT_LT(size(out.common_W - one[0].external_W), 1e-12);
}

}  // namespace
}  // namespace eciton::estimation
