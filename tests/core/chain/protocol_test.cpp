// The chain protocol in faulty worlds: what breaks it is found out, and told by a short schedule that replays
// exactly.
#include <gtest/gtest.h>

#include <iostream>

#include "tests/core/chain/protocol_world.hpp"

namespace eciton::chain::test {
namespace {

constexpr std::uint64_t seeds = 300;

WorldResult run(const Schedule& schedule, Mutation mutation = Mutation::none) {
  return World(schedule, {.mutation = mutation}).run();
}

/// Negative controls: a protocol broken on purpose has to break a promise in one of the first worlds, for a reason
/// that can be read, and only for that reason.
void expect_caught(Mutation mutation, Airframe airframe) {
  const auto fails = [&](const Schedule& schedule) { return run(schedule, mutation).violation.has_value(); };
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Schedule drawn = draw_schedule(seed, airframe);
    if (!fails(drawn)) continue;
    const Schedule shrunk = shrink(drawn, fails);
    const WorldResult first = run(shrunk, mutation), again = run(shrunk, mutation);
    ASSERT_TRUE(first.violation);
    std::cout << *first.violation << '\n' << to_text(shrunk);
    EXPECT_EQ(again.violation, first.violation);
    EXPECT_EQ(again.digest, first.digest);
    EXPECT_LT(shrunk.events.size(), drawn.events.size());
    EXPECT_LE(shrunk.events.size(), 8u);
    EXPECT_LE(shrunk.modules, 6);
    for (std::size_t k = 0; k < shrunk.events.size(); ++k) {
      Schedule less = shrunk;
      less.events.erase(less.events.begin() + static_cast<std::ptrdiff_t>(k));
      EXPECT_FALSE(fails(less)) << "not needed: " << to_text(shrunk.events[k]);
    }
    EXPECT_FALSE(run(shrunk).violation) << "the protocol as it is breaks there, too";
    return;
  }
  FAIL() << "no world out of " << seeds << " noticed";
}

class ChainProtocolTest : public testing::TestWithParam<Airframe> {};
INSTANTIATE_TEST_SUITE_P(Airframes, ChainProtocolTest, testing::Values(Airframe::chain, Airframe::lattice),
                         [](const auto& p) { return p.param == Airframe::chain ? "Chain" : "Lattice"; });

TEST_P(ChainProtocolTest, CatchesClaimsOverwrittenByTheLastArrival) {
  expect_caught(Mutation::last_arrival_wins, GetParam());
}
TEST_P(ChainProtocolTest, CatchesSilenceThatRemovesLinks) { expect_caught(Mutation::silence_unlinks, GetParam()); }
TEST_P(ChainProtocolTest, CatchesSilenceThatGoesUnnoticed) { expect_caught(Mutation::never_silent, GetParam()); }
TEST_P(ChainProtocolTest, CatchesRestartsUnderTheOldIncarnation) {
  expect_caught(Mutation::restart_forgets, GetParam());
}
TEST_P(ChainProtocolTest, CatchesViewsFlownWithoutAgreement) {
  expect_caught(Mutation::takes_for_granted, GetParam());
}

TEST_P(ChainProtocolTest, ReplaysASeedExactly) {
  int different = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Schedule schedule = draw_schedule(seed, GetParam());
    ASSERT_EQ(draw_schedule(seed, GetParam()), schedule);
    ASSERT_EQ(run(schedule).digest, run(schedule).digest) << seed;
    Schedule other_luck = schedule;
    other_luck.seed += 1000;
    different += run(schedule).digest != run(other_luck).digest;
  }
  EXPECT_GT(different, 15);  // the digest sees what happens
}

}  // namespace
}  // namespace eciton::chain::test
