// Links out of claims: both ends have to agree, contradictions make none and are named.
#include "core/chain/link_graph.hpp"

#include <gtest/gtest.h>

namespace eciton::chain {
namespace {

Claim claim(std::uint32_t module, std::uint32_t port, std::uint32_t peer, std::uint32_t peer_port) {
  return {module, port, peer, peer_port, false, LatchStatus::latched, 1, 1};
}

LinkGraph graph_of(std::initializer_list<Claim> claims) {
  ClaimTable table;
  for (const Claim& c : claims) table.join(c);
  return build_link_graph(table);
}

TEST(LinkGraphTest, LinksWhenBothEndsClaimEachOther) {
  const LinkGraph graph = graph_of({claim(7, 0, 3, 1), claim(3, 1, 7, 0)});
  ASSERT_EQ(graph.links.size(), 1u);
  EXPECT_EQ(graph.links[0], (Link{3, 1, 7, 0}));
  EXPECT_TRUE(graph.contradictions.empty());
}

TEST(LinkGraphTest, DoesNotLinkOnOneWordAlone) {
  const LinkGraph graph = graph_of({claim(7, 0, 3, 1)});
  EXPECT_TRUE(graph.links.empty());
  EXPECT_TRUE(graph.contradictions.empty());
}

TEST(LinkGraphTest, DoesNotLinkWhenOneEndsLatchIsNotClosed) {
  Claim ready = claim(3, 1, 7, 0);
  ready.latch = LatchStatus::ready;
  EXPECT_TRUE(graph_of({claim(7, 0, 3, 1), ready}).links.empty());
}

TEST(LinkGraphTest, NamesTwoModulesOnOnePort) {
  const LinkGraph graph = graph_of({claim(1, 0, 3, 1), claim(2, 0, 3, 1)});
  EXPECT_TRUE(graph.links.empty());
  ASSERT_EQ(graph.contradictions.size(), 2u);
  EXPECT_EQ(graph.contradictions[0].kind, ContradictionKind::claimed_twice);
  EXPECT_EQ(graph.contradictions[1].claim.module, 2u);
}

TEST(LinkGraphTest, KeepsALinkWhenAThirdModuleClaimsItsPort) {
  const LinkGraph graph = graph_of({claim(1, 0, 3, 1), claim(3, 1, 1, 0), claim(2, 0, 3, 1)});
  ASSERT_EQ(graph.links.size(), 1u);
  EXPECT_EQ(graph.links[0], (Link{1, 0, 3, 1}));
  ASSERT_EQ(graph.contradictions.size(), 1u);
  EXPECT_EQ(graph.contradictions[0].kind, ContradictionKind::port_taken);
  EXPECT_EQ(graph.contradictions[0].claim.module, 2u);
}

TEST(LinkGraphTest, NamesPortsThatDoNotMatch) {
  const LinkGraph graph = graph_of({claim(1, 0, 2, 1), claim(2, 0, 1, 0)});
  EXPECT_TRUE(graph.links.empty());
  ASSERT_EQ(graph.contradictions.size(), 2u);
  for (const Contradiction& c : graph.contradictions) EXPECT_EQ(c.kind, ContradictionKind::ports_mismatch);
}

TEST(LinkGraphTest, NamesAModuleThatClaimsItself) {
  const LinkGraph graph = graph_of({claim(1, 0, 1, 1), claim(1, 1, 1, 0)});
  EXPECT_TRUE(graph.links.empty());
  ASSERT_EQ(graph.contradictions.size(), 2u);
  EXPECT_EQ(graph.contradictions[0].kind, ContradictionKind::self);
}

TEST(LinkGraphTest, FindsTheComponentOfAModule) {
  const LinkGraph graph = graph_of({claim(5, 0, 2, 1), claim(2, 1, 5, 0), claim(2, 0, 9, 1), claim(9, 1, 2, 0),
                                    claim(3, 0, 4, 1), claim(4, 1, 3, 0)});
  BoundedVector<std::uint32_t, max_modules> members;
  ASSERT_TRUE(component_of(9, graph, members));
  ASSERT_EQ(members.size(), 3u);
  EXPECT_EQ(members[0], 2u);
  EXPECT_EQ(members[1], 5u);
  EXPECT_EQ(members[2], 9u);
  ASSERT_TRUE(component_of(8, graph, members));
  EXPECT_EQ(members.size(), 1u);
}

}  // namespace
}  // namespace eciton::chain
