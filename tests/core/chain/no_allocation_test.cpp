// The chain logic is called from steps, so it never allocates once constructed: counted, not believed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <new>

#include "core/chain/agreement.hpp"

namespace {
thread_local int allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace eciton::chain {
namespace {

TEST(NoAllocationTest, NeitherJoiningNorAgreeingAllocates) {
  const ChainRule rule;
  Agreement agreement({.module = 1, .incarnation = 1}, rule);
  ClaimTable claims;
  AnnouncementTable announcements;
  const PeerStatus peer{.module = 2, .fresh = true, .clock_offset = Duration{}};

  const int before = allocations;
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
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(agreement.announcement().has_start());

  const auto control = std::make_unique<int>(0);
  EXPECT_GT(allocations, before) << "the count itself has to work";
}

}  // namespace
}  // namespace eciton::chain
