// The chain logic is called from steps, so it never allocates once constructed.
#include <gtest/gtest.h>

#include "core/chain/agreement.hpp"
#include "tests/allocation_guard/allocation_guard.hpp"

namespace eciton::chain {
namespace {

TEST(NoAllocationTest, NeitherJoiningNorAgreeingAllocates) {
  if (!testing::AllocationGuard::available()) GTEST_SKIP() << "the sanitizers bring a heap of their own";
  const ChainRule rule;
  Agreement agreement({.module = 1, .incarnation = 1}, rule);
  ClaimTable claims;
  AnnouncementTable announcements;
  const PeerStatus peer{.module = 2, .fresh = true, .clock_offset = Duration{}};

  testing::AllocationGuard guard;
  for (std::uint64_t k = 1; k <= 100; ++k) {
    const bool linked = k % 2 == 0;
    const auto latch = linked ? LatchStatus::latched : LatchStatus::open;
    claims.join({1, 0, 2, 1, !linked, latch, 1, k});
    claims.join({2, 1, 1, 0, !linked, latch, 1, k});
    claims.join({.module = 1, .port = 1, .incarnation = 1});
    agreement.update(TimePoint{Duration{static_cast<std::int64_t>(k)} + 1s}, claims, announcements, {&peer, 1});
    announcements.join({.module = 2, .sequence_number = k, .epoch = agreement.announcement().epoch});
    agreement.update(TimePoint{Duration{static_cast<std::int64_t>(k)} + 2s}, claims, announcements, {&peer, 1});
  }
  EXPECT_EQ(guard.framework(), 0u) << guard.describe();
  EXPECT_TRUE(agreement.announcement().has_start());
}

}  // namespace
}  // namespace eciton::chain
