// Ten thousand faulty worlds, half of them here: never-events never, and what is linked is flown within the bound.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <vector>

#include "tests/core/chain/protocol_world.hpp"

namespace eciton::chain::test {
namespace {

/// Half of all seeds, the two programs taking turns; only the one that ECITON_SEED names, if it does.
std::vector<std::uint64_t> seeds() {
  if (const char* const one = std::getenv("ECITON_SEED")) return {std::strtoull(one, nullptr, 10)};
  const std::uint64_t count = std::getenv("ECITON_NIGHTLY") != nullptr ? 10 * ECITON_SEEDS : ECITON_SEEDS;
  std::vector<std::uint64_t> half(count);
  for (std::uint64_t k = 0; k < count; ++k) half[k] = ECITON_FIRST_SEED + 2 * k;
  return half;
}

TEST(ChainSeedsTest, KeepsItsPromisesInEveryFaultyWorld) {
  WorldResult total;
  const auto all = seeds();
  for (const std::uint64_t seed : all) {
    const Schedule schedule = draw_schedule(seed, seed % 8 < 2 ? Airframe::lattice : Airframe::chain);
    const WorldResult result = World(schedule, {}).run();
    if (result.violation) {
      const auto fails = [](const Schedule& s) { return World(s, {}).run().violation.has_value(); };
      const Schedule shrunk = shrink(schedule, fails);
      FAIL() << *result.violation << "\nin short: " << *World(shrunk, {}).run().violation << '\n' << to_text(shrunk);
    }
    total.docked += result.docked;
    total.undocked += result.undocked;
    total.crashed += result.crashed;
    total.partitions += result.partitions;
    total.refused += result.refused > 0;
    total.false_claims += result.false_claims;
    total.chains_activated += result.chains_activated;
    total.largest = std::max(total.largest, result.largest);
    total.convergence_max = std::max(total.convergence_max, result.convergence_max);
  }
  std::cout << all.size() << " worlds: docked " << total.docked << ", undocked " << total.undocked << ", crashed "
            << total.crashed << ", partitions " << total.partitions << ", false claims " << total.false_claims
            << ", rings in " << total.refused << " worlds, chains activated " << total.chains_activated
            << ", largest " << total.largest << ", slowest agreement " << to_s(total.convergence_max) << " s\n";
  // Worlds in which nothing happens would keep every promise.
  if (all.size() == 1) return;
  const int worlds = static_cast<int>(all.size());
  EXPECT_GT(total.chains_activated, 3 * worlds);
  EXPECT_GT(total.undocked, worlds);
  EXPECT_GT(total.crashed, worlds);
  EXPECT_GT(total.partitions, worlds);
  EXPECT_GT(total.false_claims, worlds / 2);
  EXPECT_GT(total.refused, worlds / 100);
  EXPECT_GE(total.largest, 6);
}

}  // namespace
}  // namespace eciton::chain::test
