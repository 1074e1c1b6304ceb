// Contact wrenches against a case by hand and against a dense least-squares solve of (9).
#include "services/estimation/contact_wrench.hpp"

#include <gtest/gtest.h>

#include <cmath>
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
      // A force on each, and a turn (the moment here, N/m) that pushes by the lever and twists by 0.2 m of it.
      W = {common.force + common.moment.cross(members[i].r_W - mean), 0.04 * common.moment};
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

/// (8) to (10) solved densely, with nothing of the code under test: unknown are the contact wrenches and the common
/// disturbance: a force on each member, and a turn t about the mean of the r, which each feels as t x rho and 0.04 t.
/// As many unknowns as equations. Returns c_1, c_2,
/// ...
std::vector<Vector6> dense_contacts(const std::vector<MemberWrench>& members) {
  const auto n = static_cast<Eigen::Index>(members.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  Eigen::VectorXd W(6 * n);
  Vector3 mean = Vector3::Zero();
  for (const MemberWrench& m : members) mean += m.r_W / static_cast<double>(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const MemberWrench& m = members[static_cast<std::size_t>(i)];
    W.segment<6>(6 * i) = stacked(m.external_W);
    if (i > 0) A.block<6, 6>(6 * i, 6 * i - 6) = X(members[static_cast<std::size_t>(i - 1)].port_to_next_W - m.r_W);
    if (i + 1 < n) A.block<6, 6>(6 * i, 6 * i) = -X(m.port_to_next_W - m.r_W);
    A.block<3, 3>(6 * i, 6 * n - 6).setIdentity();
    A.block<3, 3>(6 * i, 6 * n - 3) = -robot::skew(m.r_W - mean);
    A.block<3, 3>(6 * i + 3, 6 * n - 3) = 0.04 * Eigen::Matrix3d::Identity();
  }
  const Eigen::VectorXd solution = A.colPivHouseholderQr().solve(W);
  EXPECT_LT((A * solution - W).norm(), 1e-10) << "every set of wrenches is explained exactly";
  std::vector<Vector6> contacts;
  for (Eigen::Index i = 0; i + 1 < n; ++i) contacts.push_back(solution.segment<6>(6 * i));
  return contacts;
}

TEST(ContactWrenchTest, EqualsTheDenseSolutionAndTheTruthOnRandomChains) {
  for (std::size_t n = 2; n <= 8; ++n) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      const Chain chain(n, 100 * static_cast<unsigned>(n) + seed, {{1, 4, -0.5}, {0.02, -0.05, 0.1}});
      const ContactWrenches out = contact_wrenches(chain.members);
      const std::vector<Vector6> dense = dense_contacts(chain.members);
      for (std::size_t i = 0; i + 1 < n; ++i) {
        const Vector6 running = stacked(out.members[i].contact_W);
        EXPECT_LT((running - dense[i]).norm(), 1e-12 * (1 + dense[i].norm())) << n << " " << seed;
        EXPECT_LT((running - stacked(chain.contacts[i])).norm(), 1e-12 * (1 + dense[i].norm())) << n << " " << seed;
      }
    }
  }
}

TEST(ContactWrenchTest, WithNoiseOnTheWrenchesItStillEqualsTheDenseSolution) {
  // Wrenches that no chain can feel exactly: then the constraint, and not luck, decides.
  std::mt19937 rng(5);
  std::normal_distribution<double> noise(0, 0.3);
  for (std::size_t n = 2; n <= 8; ++n) {
    Chain chain(n, static_cast<unsigned>(n), {{1, 4, -0.5}, {0.02, -0.05, 0.1}});
    for (MemberWrench& m : chain.members) {
      for (int k = 0; k < 3; ++k) {
        m.external_W.force[k] += noise(rng);
        m.external_W.moment[k] += 0.1 * noise(rng);
      }
    }
    const ContactWrenches out = contact_wrenches(chain.members);
    const std::vector<Vector6> dense = dense_contacts(chain.members);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      EXPECT_LT((stacked(out.members[i].contact_W) - dense[i]).norm(), 1e-12 * (1 + dense[i].norm())) << n;
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

TEST(ContactWrenchTest, AMemberNeverHeardOfLeavesTheOthersAnEstimate) {
  // Member 2 of 0..3 has not spoken. In a wind, 0 pushes 1; nothing else touches.
  const Wrench wind{{0, 4, 0}, {0, 0, 0}}, push{{-3, 0, 0}, {0, 0, 0}};
  std::vector<MemberWrench> m(4);
  for (const std::size_t k : {0u, 1u, 3u}) {
    const double x = -0.8 * static_cast<double>(k);
    m[k] = {.known = true,
            .age_s = 0.01,
            .external_W = wind,
            .r_W = {x, 0, 1},
            .port_to_next_W = {x - 0.4, 0, 1},
            .port_to_last_W = {x + 0.4, 0, 1}};
  }
  m[0].external_W -= push;
  m[1].external_W += push;
  m[2].external_W = {Vector3::Constant(std::nan("")), Vector3::Constant(std::nan(""))};  // whatever lies there
  const ContactWrenches out = contact_wrenches(m);
  EXPECT_FALSE(out.complete);
  EXPECT_EQ(out.fresh, 3u);
  EXPECT_LT(size(out.common_W - wind), 1e-12);
  EXPECT_LT(size(out.members[0].contact_W - push), 1e-12);
  EXPECT_EQ(out.members[0].link_freshness, 1);
  EXPECT_EQ(out.members[1].link_freshness, 0);
  EXPECT_EQ(out.members[2].link_freshness, 0);
  EXPECT_LT(size(out.members[1].contact_W) + size(out.members[2].contact_W), 1e-12);
  EXPECT_LT((out.members[2].r_W - Vector3(-1.6, 0, 1)).norm(), 1e-12) << "straight on from its neighbour";
  EXPECT_LT((out.members[1].link_W - Vector3(-1.2, 0, 1)).norm(), 1e-12);
  EXPECT_LT((out.members[2].link_W - Vector3(-2.0, 0, 1)).norm(), 1e-12);
}

TEST(ContactWrenchTest, NeverHeardIsWhatSilentForEverIs) {
  Chain heard(5, 4, {{0.5, 4, 0}, {0.01, 0, 0}}), silent = heard;
  heard.members[0].known = heard.members[3].known = false;
  silent.members[0].age_s = silent.members[3].age_s = 100;
  const ContactWrenches a = contact_wrenches(heard.members), b = contact_wrenches(silent.members);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_LT(size(a.members[k].d_W - b.members[k].d_W), 1e-12) << k;
    const Vector3 lever = a.members[k].link_W - b.members[k].link_W;  // a guessed docking point is another one
    EXPECT_LT(size(robot::shift(a.members[k].contact_W, lever) - b.members[k].contact_W), 1e-12) << k;
  }
}

TEST(ContactWrenchTest, WithNobodyKnownThereIsNothing) {
  Chain chain(3, 3, {});
  for (MemberWrench& m : chain.members) m.known = false;
  const ContactWrenches out = contact_wrenches(chain.members);
  EXPECT_EQ(out.fresh, 0u);
  for (const MemberContact& m : out.members) EXPECT_EQ(size(m.d_W) + size(m.contact_W), 0);
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
