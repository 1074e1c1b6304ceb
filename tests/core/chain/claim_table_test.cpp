// The join of claims: newest wins, and order, loss and duplication do not matter.
#include "core/chain/claim_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace eciton::chain {
namespace {

Claim claim(std::uint32_t module, std::uint32_t port, std::uint32_t peer, std::uint32_t peer_port,
            std::uint64_t incarnation = 1, std::uint64_t sequence_number = 1) {
  return {module, port, peer, peer_port, false, LatchStatus::latched, incarnation, sequence_number};
}

TEST(ClaimTableTest, KeepsTheNewestOfOneIncarnation) {
  ClaimTable table;
  EXPECT_EQ(table.join(claim(1, 0, 2, 1, 1, 5)), ClaimTable::Joined::changed);
  EXPECT_EQ(table.join(claim(1, 0, 3, 1, 1, 4)), ClaimTable::Joined::unchanged);
  EXPECT_EQ(table.find(1, 0)->peer, 2u);
  EXPECT_EQ(table.join(claim(1, 0, 3, 1, 1, 6)), ClaimTable::Joined::changed);
  EXPECT_EQ(table.find(1, 0)->peer, 3u);
}

TEST(ClaimTableTest, LetsARestartedModuleSupersedeOnlyThePortsItSpeaksFor) {
  ClaimTable table;
  table.join(claim(1, 0, 2, 1, 1, 50));
  table.join(claim(1, 1, 3, 0, 1, 51));
  Claim withdrawal = claim(1, 0, 0, 0, 2, 1);
  withdrawal.withdrawn = true;
  table.join(withdrawal);
  EXPECT_FALSE(table.find(1, 0)->holds());
  EXPECT_TRUE(table.find(1, 1)->holds());
  EXPECT_EQ(table.find(1, 1)->incarnation, 1u);
}

TEST(ClaimTableTest, HoldsOnlyWhileTheLatchReports) {
  Claim c = claim(1, 0, 2, 1);
  EXPECT_TRUE(c.holds());
  c.latch = LatchStatus::ready;
  EXPECT_FALSE(c.holds());
  c.latch = LatchStatus::latched;
  c.withdrawn = true;
  EXPECT_FALSE(c.holds());
}

TEST(ClaimTableTest, KnowsWhoClaimsAPortUnlessTwoDo) {
  ClaimTable table;
  EXPECT_EQ(table.claimant_of(2, 1), nullptr);
  table.join(claim(1, 0, 2, 1));
  ASSERT_NE(table.claimant_of(2, 1), nullptr);
  EXPECT_EQ(table.claimant_of(2, 1)->module, 1u);
  table.join(claim(3, 0, 2, 1));
  EXPECT_EQ(table.claimant_of(2, 1), nullptr);
}

TEST(ClaimTableTest, RefusesAndCountsWhatFindsNoPlace) {
  ClaimTable table;
  for (std::uint32_t module = 1; module <= max_modules; ++module) {
    for (std::uint32_t port = 0; port < max_ports; ++port)
      ASSERT_EQ(table.join(claim(module, port, 0, 0)), ClaimTable::Joined::changed);
  }
  const ClaimTable before = table;
  EXPECT_EQ(table.join(claim(17, 0, 1, 1)), ClaimTable::Joined::refused);
  EXPECT_EQ(table.refused(), 1u);
  EXPECT_EQ(table, before);
  EXPECT_EQ(table.join(claim(16, 3, 1, 1, 1, 2)), ClaimTable::Joined::changed);
}

TEST(ClaimTableTest, CountsOneVersionWithTwoContents) {
  ClaimTable table;
  table.join(claim(1, 0, 2, 1));
  table.join(claim(1, 0, 2, 1));
  EXPECT_EQ(table.conflicts(), 0u);
  table.join(claim(1, 0, 3, 1));
  EXPECT_EQ(table.conflicts(), 1u);
}

/// Claims drawn close together, so that versions tie and contents conflict often.
std::vector<Claim> random_claims(std::mt19937_64& random, int count) {
  const auto draw = [&](std::uint64_t n) { return static_cast<std::uint32_t>(random() % n); };
  std::vector<Claim> claims;
  for (int k = 0; k < count; ++k) {
    Claim c = claim(1 + draw(6), draw(2), 1 + draw(6), draw(2), 1 + draw(3), 1 + draw(4));
    c.withdrawn = draw(3) == 0;
    c.latch = static_cast<LatchStatus>(draw(3));
    claims.push_back(c);
  }
  return claims;
}

ClaimTable joined(const std::vector<Claim>& claims) {
  ClaimTable table;
  for (const Claim& c : claims) table.join(c);
  return table;
}

TEST(ClaimTableTest, JoinsTheSameInAnyOrderAnyGroupingAndAnyNumberOfTimes) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    std::vector<Claim> claims = random_claims(random, 40);
    const ClaimTable expected = joined(claims);

    std::vector<Claim> shuffled = claims;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    shuffled.insert(shuffled.end(), claims.begin(), claims.begin() + 20);  // duplicates
    ASSERT_EQ(joined(shuffled), expected);

    const auto third = [&](int k) {
      return joined({claims.begin() + k * 13, k == 2 ? claims.end() : claims.begin() + (k + 1) * 13});
    };
    const ClaimTable a = third(0), b = third(1), c = third(2);
    ClaimTable left = a, right = b, a_then_right = a, reversed = c;
    left.join(b);
    left.join(c);
    right.join(c);
    a_then_right.join(right);
    reversed.join(b);
    reversed.join(a);
    reversed.join(reversed);
    ASSERT_EQ(left, expected);
    ASSERT_EQ(a_then_right, expected);
    ASSERT_EQ(reversed, expected);
  }
}

}  // namespace
}  // namespace eciton::chain
