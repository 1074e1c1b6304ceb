// Chains, rings, views and epochs; and a lattice, which shows that the rule is a seam.
#include "core/chain/structure.hpp"

#include <gtest/gtest.h>

#include <map>

#include "core/chain/view.hpp"
#include "tests/core/chain/lattice_rule.hpp"

namespace eciton::chain {
namespace {

using test::LatticeRule;

void link(ClaimTable& claims, Link l, std::uint64_t sequence_number = 1, std::uint64_t incarnation = 1) {
  claims.join({l.module, l.port, l.peer, l.peer_port, false, LatchStatus::latched, incarnation, sequence_number});
  claims.join({l.peer, l.peer_port, l.module, l.port, false, LatchStatus::latched, incarnation, sequence_number});
}

void withdraw(ClaimTable& claims, std::uint32_t module, std::uint32_t port, std::uint64_t sequence_number) {
  claims.join({.module = module, .port = port, .incarnation = 1, .sequence_number = sequence_number});
}

View view_in(const ClaimTable& claims, std::uint32_t module, const StructureRule& rule = ChainRule()) {
  View view;
  EXPECT_EQ(view_of(module, claims, build_link_graph(claims), rule, view), Refusal::none);
  return view;
}

std::vector<std::uint32_t> order(const View& view) { return {view.members.begin(), view.members.end()}; }

TEST(ChainRuleTest, NumbersFromTheModuleWhoseFemalePortIsFree) {
  ClaimTable claims;  // male of 7 in female of 2, male of 2 in female of 5
  link(claims, {2, 0, 5, 1});
  link(claims, {7, 0, 2, 1});
  for (const std::uint32_t module : {2u, 5u, 7u}) {
    const View view = view_in(claims, module);
    EXPECT_EQ(order(view), (std::vector<std::uint32_t>{7, 2, 5}));
    ASSERT_EQ(view.links.size(), 2u);
    EXPECT_EQ(view.links[0], (Link{7, 0, 2, 1}));
    EXPECT_EQ(view.links[1], (Link{2, 0, 5, 1}));
    EXPECT_EQ(view.base, 2u);
  }
}

TEST(ChainRuleTest, TakesTheBaseInTheMiddleRoundedDown) {
  const std::map<std::uint32_t, std::uint32_t> base_of{{1, 1}, {2, 1}, {3, 2}, {4, 2}, {5, 3}, {8, 4}, {16, 8}};
  for (const auto& [n, base] : base_of) {
    ClaimTable claims;
    for (std::uint32_t k = 1; k < n; ++k) link(claims, {k, 0, k + 1, 1});
    EXPECT_EQ(view_in(claims, 1).base, base) << n;
  }
}

TEST(ChainRuleTest, RefusesARing) {
  ClaimTable claims;
  link(claims, {1, 0, 2, 1});
  link(claims, {2, 0, 3, 1});
  link(claims, {3, 0, 1, 1});
  View view;
  const Refusal refusal = view_of(2, claims, build_link_graph(claims), ChainRule(), view);
  EXPECT_EQ(refusal, Refusal::ring);
  EXPECT_EQ(to_text(refusal), "the links close to a ring");
  EXPECT_TRUE(view.members.empty());
}

TEST(ChainRuleTest, RefusesPortsThatDoNotFit) {
  ClaimTable claims;
  link(claims, {1, 0, 2, 0});
  View view;
  EXPECT_EQ(view_of(1, claims, build_link_graph(claims), ChainRule(), view), Refusal::forbidden_ports);
  ClaimTable lattice_port;
  link(lattice_port, {1, 0, 2, 3});
  EXPECT_EQ(view_of(1, lattice_port, build_link_graph(lattice_port), ChainRule(), view), Refusal::forbidden_ports);
}

TEST(LatticeRuleTest, ArrangesASquareWhichIsNoRingThere) {
  ClaimTable claims;           // 4 3
  link(claims, {1, 0, 2, 2});  // 1 2
  link(claims, {2, 1, 3, 3});
  link(claims, {3, 2, 4, 0});
  link(claims, {4, 3, 1, 1});
  const View view = view_in(claims, 3, LatticeRule());
  EXPECT_EQ(order(view), (std::vector<std::uint32_t>{1, 2, 4, 3}));
  EXPECT_EQ(view.links.size(), 4u);
  EXPECT_EQ(view.base, 2u);
  EXPECT_NE(view.epoch, 0u);
}

TEST(LatticeRuleTest, RefusesLinksThatFitNoGrid) {
  ClaimTable claims;
  link(claims, {1, 0, 2, 2});
  link(claims, {2, 0, 3, 2});
  link(claims, {3, 1, 1, 3});
  View view;
  EXPECT_EQ(view_of(1, claims, build_link_graph(claims), LatticeRule(), view), Refusal::inconsistent);
}

TEST(EpochTest, IsZeroForASingleModuleAndNeverForAChain) {
  ClaimTable claims;
  withdraw(claims, 4, 0, 1);
  EXPECT_EQ(view_in(claims, 4).epoch, 0u);
  for (std::uint64_t k = 2; k < 2000; ++k) {
    link(claims, {4, 0, 5, 1}, k);
    ASSERT_NE(view_in(claims, 4).epoch, 0u);
  }
}

TEST(EpochTest, IsEqualOnAllMembersAndBlindToStrangers) {
  ClaimTable claims;
  link(claims, {1, 0, 2, 1});
  link(claims, {2, 0, 3, 1});
  const std::uint64_t epoch = view_in(claims, 1).epoch;
  EXPECT_EQ(view_in(claims, 2).epoch, epoch);
  EXPECT_EQ(view_in(claims, 3).epoch, epoch);
  link(claims, {8, 0, 9, 1});
  EXPECT_EQ(view_in(claims, 1).epoch, epoch);
  EXPECT_NE(view_in(claims, 8).epoch, epoch);
}

TEST(EpochTest, IsNewWhenTheSameModulesDockAgainOrRestart) {
  ClaimTable claims;
  link(claims, {1, 0, 2, 1}, 1);
  const std::uint64_t first = view_in(claims, 1).epoch;
  withdraw(claims, 1, 0, 2);
  withdraw(claims, 2, 1, 2);
  EXPECT_EQ(view_in(claims, 1).epoch, 0u);
  link(claims, {1, 0, 2, 1}, 3);
  const std::uint64_t again = view_in(claims, 1).epoch;
  EXPECT_NE(again, first);
  link(claims, {1, 0, 2, 1}, 1, 2);
  EXPECT_NE(view_in(claims, 1).epoch, again);
  EXPECT_NE(view_in(claims, 1).epoch, first);
}

TEST(EpochTest, IsNewForAStructureThatOthersJoinedAndLeft) {
  ClaimTable claims;
  link(claims, {1, 0, 2, 1}, 1);
  const std::uint64_t before = view_in(claims, 1).epoch;
  link(claims, {2, 0, 3, 1}, 1);
  ASSERT_EQ(view_in(claims, 1).members.size(), 3u);
  withdraw(claims, 3, 1, 2);  // only the one that leaves says so yet
  const View after = view_in(claims, 1);
  EXPECT_EQ(order(after), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_NE(after.epoch, before);
  // The other way round: 2 claims one-sidedly, 3 joins and leaves while 2's claim stands untouched.
  ClaimTable one_sided;
  link(one_sided, {1, 0, 2, 1}, 1);
  one_sided.join({2, 0, 3, 1, false, LatchStatus::latched, 1, 1});
  const std::uint64_t waiting = view_in(one_sided, 1).epoch;
  one_sided.join({3, 1, 2, 0, false, LatchStatus::latched, 1, 1});
  withdraw(one_sided, 3, 1, 2);
  EXPECT_NE(view_in(one_sided, 1).epoch, waiting);
}

}  // namespace
}  // namespace eciton::chain
