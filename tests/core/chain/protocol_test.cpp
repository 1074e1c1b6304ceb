// The chain protocol over hundreds of seeded, faulty worlds: never-events never, agreement in time.
#include <gtest/gtest.h>

#include <iostream>

#include "tests/core/chain/protocol_world.hpp"

namespace eciton::chain::test {
namespace {

constexpr std::uint64_t seeds = 300;

TEST(ChainProtocolTest, KeepsItsPromisesInEveryFaultyWorld) {
  WorldResult total;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const WorldResult result = World({.seed = seed}).run();
    EXPECT_FALSE(result.violation) << *result.violation;
    total.docked += result.docked;
    total.undocked += result.undocked;
    total.crashed += result.crashed;
    total.partitions += result.partitions;
    total.chains_activated += result.chains_activated;
  }
  // Worlds in which nothing happens would keep every promise.
  EXPECT_GT(total.chains_activated, 1000);
  std::cout << "docked " << total.docked << ", undocked " << total.undocked << ", crashed " << total.crashed
            << ", partitions " << total.partitions << ", chains activated " << total.chains_activated << '\n';
}

/// Negative controls: a protocol broken on purpose has to break a promise in one of the same worlds.
void expect_caught(Mutation mutation) {
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const auto violation = World({.seed = seed, .mutation = mutation}).run().violation;
    if (!violation) continue;
    std::cout << "caught: " << *violation << '\n';
    return;
  }
  FAIL() << "no world out of " << seeds << " noticed";
}

TEST(ChainProtocolTest, CatchesClaimsOverwrittenByTheLastArrival) { expect_caught(Mutation::last_arrival_wins); }
TEST(ChainProtocolTest, CatchesSilenceThatRemovesLinks) { expect_caught(Mutation::silence_unlinks); }
TEST(ChainProtocolTest, CatchesSilenceThatGoesUnnoticed) { expect_caught(Mutation::never_silent); }
TEST(ChainProtocolTest, CatchesRestartsUnderTheOldIncarnation) { expect_caught(Mutation::restart_forgets); }
TEST(ChainProtocolTest, CatchesViewsFlownWithoutAgreement) { expect_caught(Mutation::takes_for_granted); }

}  // namespace
}  // namespace eciton::chain::test
