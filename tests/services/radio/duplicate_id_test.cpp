// A restart is no duplicate, a late beacon neither; two modules that go on by turns are.
#include "services/radio/duplicate_id.hpp"

#include <gtest/gtest.h>

namespace eciton::radio {
namespace {

constexpr TimePoint t0{1000s};

TEST(DuplicateIdTest, TakesOneChangeForARestart) {
  DuplicateId id;
  for (int k = 0; k < 10; ++k) id.hear(t0 + k * 1s, k < 5 ? 1 : 2, t0 + k * 1s);
  EXPECT_FALSE(id.met(t0 + 10s));
}

TEST(DuplicateIdTest, TakesManyRestartsForWhatTheyAre) {
  DuplicateId id;
  for (std::uint64_t k = 0; k < 20; ++k) id.hear(t0 + k * 1s, k, t0 + k * 1s);
  EXPECT_FALSE(id.met(t0 + 20s));
}

TEST(DuplicateIdTest, DoesNotMindOldBeaconsThatComeLate) {
  DuplicateId id;
  id.hear(t0, 1, t0);
  id.hear(t0 + 1s, 2, t0 + 1s);
  for (int k = 0; k < 5; ++k) id.hear(t0 + 2s, 1, t0 - k * 100ms);
  EXPECT_FALSE(id.met(t0 + 2s));
}

TEST(DuplicateIdTest, MeetsTwoModulesThatTakeTurns) {
  DuplicateId id;
  id.hear(t0, 7, t0);
  id.hear(t0 + 1s, 3, t0 - 5s);  // the other's clock is its own
  id.hear(t0 + 2s, 7, t0 + 2s);
  EXPECT_FALSE(id.met(t0 + 2s));
  id.hear(t0 + 3s, 3, t0 - 3s);
  EXPECT_TRUE(id.met(t0 + 3s));
}

TEST(DuplicateIdTest, ForgetsWhenTheOtherIsGone) {
  DuplicateId id;
  for (int k = 0; k < 10; ++k) id.hear(t0 + k * 1s, k % 2 == 0 ? 1 : 2, t0 + k * 1s);
  EXPECT_TRUE(id.met(t0 + 10s));
  for (int k = 10; k < 60; ++k) id.hear(t0 + k * 1s, 1, t0 + k * 1s);
  EXPECT_FALSE(id.met(t0 + 60s));
}

}  // namespace
}  // namespace eciton::radio
