// The contact wrench laws on a static plant: a rigid chain whose members' pose controls are springs of any
// stiffness pulling towards places that do not agree.
#include "services/control/contact_wrench_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "services/estimation/contact_wrench.hpp"

namespace eciton::control {
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
Wrench wrench(const Vector6& v) { return {v.head<3>(), v.tail<3>()}; }
Matrix6 X(const Vector3& a) {
  Matrix6 out = Matrix6::Identity();
  out.bottomLeftCorner<3, 3>() = robot::skew(a);
  return out;
}

class StaticChain {
 public:
  StaticChain(std::size_t n, unsigned seed) : rng_(seed), r(n), P(n), pull(n), K(n), ff(n) {
    for (std::size_t i = 0; i < n; ++i) {
      r[i] = Vector3(-0.8 * static_cast<double>(i), 0, 1) + random(0.2);
      P[i] = r[i] - Vector3(0.4, 0, 0) + random(0.05);
      pull[i] = {random(3), random(0.3)};
      const Matrix6 A = Matrix6::NullaryExpr([&] { return random(1).x(); });
      K[i] = 20 * Matrix6::Identity() + 10 * A * A.transpose();
    }
  }
  std::size_t size() const { return r.size(); }

  /// External wrenches of the members in equilibrium: what the springs and the feed-forward do not balance.
  std::vector<estimation::MemberWrench> settle() const {
    Matrix6 stiffness = Matrix6::Zero();
    Vector6 total = Vector6::Zero();
    for (std::size_t i = 0; i < size(); ++i) {
      stiffness += X(r[i]) * K[i] * X(r[i]).transpose();
      total += X(r[i]) * stacked(pull[i] + ff[i]);
    }
    const Vector6 moved = stiffness.ldlt().solve(total);  // of the whole chain, about the world's origin
    std::vector<estimation::MemberWrench> out(size());
    for (std::size_t i = 0; i < size(); ++i) {
      out[i].known = true;
      out[i].r_W = r[i];
      out[i].port_to_next_W = P[i];
      if (i > 0) out[i].port_to_last_W = P[i - 1];
      out[i].external_W = wrench(K[i] * X(r[i]).transpose() * moved - stacked(pull[i] + ff[i]));
    }
    return out;
  }
  std::vector<ChainMember> members() const {
    const estimation::ContactWrenches contact = estimation::contact_wrenches(settle());
    std::vector<ChainMember> out(size());
    for (std::size_t i = 0; i < size(); ++i) {
      const estimation::MemberContact& m = contact.members[i];
      out[i] = {m.d_W, m.contact_W, r[i], m.link_W, 0};
    }
    return out;
  }
  Vector3 random(double size) {
    std::uniform_real_distribution<double> u(-size, size);
    const double x = u(rng_), y = u(rng_), z = u(rng_);
    return {x, y, z};
  }

 private:
  std::mt19937 rng_;

 public:
  std::vector<Vector3> r, P;
  std::vector<Wrench> pull;
  std::vector<Matrix6> K;
  std::vector<Wrench> ff;
};

double worst_contact(const std::vector<ChainMember>& members, const std::vector<Wrench>& desired) {
  double worst = 0;
  for (std::size_t i = 0; i + 1 < members.size(); ++i) {
    const Wrench wanted = desired.empty() ? Wrench{} : desired[i];
    worst = std::max(worst, stacked(members[i].contact_W - wanted).norm());
  }
  return worst;
}

TEST(ContactWrenchLawTest, TheBaseIsTheMiddleAsNumbered) {
  EXPECT_EQ(base_index(2), 0u);  // number 1 of 2, 2 of 3, 2 of 4, 3 of 5
  EXPECT_EQ(base_index(3), 1u);
  EXPECT_EQ(base_index(4), 1u);
  EXPECT_EQ(base_index(5), 2u);
}

TEST(ContactWrenchLawTest, TheLocalLawsLoopGainIsTheIdentityForAnyChain) {
  for (const std::size_t n : {2u, 3u, 8u, 16u}) {
    StaticChain chain(n, static_cast<unsigned>(n));
    std::vector<Wrench> desired(n - 1);
    for (Wrench& w : desired) w = {chain.random(1), chain.random(0.1)};
    const std::vector<ChainMember> before = chain.members();
    constexpr double gamma = 0.25;
    Wrench net;
    for (std::size_t i = 0; i < n; ++i) {
      const Wrench step = local_step(before, i, desired) * gamma;
      chain.ff[i] += step;
      net += robot::shift(step, chain.r[i]);
    }
    const std::vector<ChainMember> after = chain.members();
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const Vector6 was = stacked(before[i].contact_W - desired[i]), is = stacked(after[i].contact_W - desired[i]);
      EXPECT_LT((is - (1 - gamma) * was).norm(), 1e-11) << n;
    }
    EXPECT_LT(stacked(net).norm(), 1e-11);  // so pose tracking is undisturbed
  }
}

TEST(ContactWrenchLawTest, ThePapersStepSolvesItsEquationsWithTheBaseAtZero) {
  StaticChain chain(5, 4);
  std::vector<Wrench> desired(4);
  for (Wrench& w : desired) w = {chain.random(1), chain.random(0.1)};
  const std::vector<ChainMember> m = chain.members();
  EXPECT_EQ(stacked(paper_step(m, base_index(5), desired)).norm(), 0);
  for (std::size_t i = 0; i + 1 < 5; ++i) {
    const Wrench here = robot::shift(paper_step(m, i, desired), m[i].r_W - m[i].link_W);
    const Wrench next = robot::shift(paper_step(m, i + 1, desired), m[i + 1].r_W - m[i].link_W);
    EXPECT_LT(stacked((here - next) - (desired[i] - m[i].contact_W)).norm(), 1e-12);
  }
}

TEST(ContactWrenchLawTest, BothLawsBringTheContactDownTheLocalOneSooner) {
  for (const ContactLaw law : {ContactLaw::local, ContactLaw::paper}) {
    StaticChain chain(3, 8);
    std::vector<ContactWrenchLaw> laws(3, ContactWrenchLaw({.law = law}));
    const double start = worst_contact(chain.members(), {});
    double after_1_s = 0;
    for (int k = 0; k < 1500; ++k) {
      const std::vector<ChainMember> m = chain.members();
      for (std::size_t i = 0; i < 3; ++i) chain.ff[i] = laws[i].update(m, i, {}, 0.01);
      if (k == 100) after_1_s = worst_contact(m, {});
    }
    EXPECT_LT(worst_contact(chain.members(), {}), 0.02 * start);
    // Local: exp(-K_I/3 t) after 1 s.
    if (law == ContactLaw::local) {
      EXPECT_NEAR(after_1_s / start, std::exp(-10.0 / 3), 0.01);
    } else {
      EXPECT_GT(after_1_s / start, 0.1);
    }
  }
}

TEST(ContactWrenchLawTest, WithoutALawNothingIsFedForward) {
  StaticChain chain(3, 8);
  ContactWrenchLaw law({.law = ContactLaw::none});
  EXPECT_EQ(stacked(law.update(chain.members(), 0, {}, 0.01)).norm(), 0);
}

TEST(ContactWrenchLawTest, TheFeedForwardIsClampedAndSaysSo) {
  StaticChain chain(2, 1);
  chain.pull[0].force = {500, 0, 0};
  ContactWrenchLaw law;
  for (int k = 0; k < 1000; ++k) law.update(chain.members(), 0, {}, 0.01);
  EXPECT_LE(law.feed_forward_W().force.cwiseAbs().maxCoeff(), 15);
  EXPECT_TRUE(law.clamped());
}

TEST(ContactWrenchLawTest, SilentPeersLetTheFeedForwardFade) {
  std::vector<ChainMember> silent(2);
  silent[1].r_W = {-0.8, 0, 0};
  silent[1].age_s = 3;
  ContactWrenchLaw law;
  law.set_feed_forward({{2, 0, 0}, {0, 0, 0}});
  for (int k = 0; k < 100; ++k) law.update(silent, 0, {}, 0.01);
  EXPECT_NEAR(law.feed_forward_W().force.x(), 2 * std::exp(-0.2), 1e-9);
  silent[1].age_s = 0.1;  // late, but fresh enough
  for (int k = 0; k < 100; ++k) law.update(silent, 0, {}, 0.01);
  EXPECT_NEAR(law.feed_forward_W().force.x(), 2 * std::exp(-0.2), 1e-9);
}

}  // namespace
}  // namespace eciton::control
