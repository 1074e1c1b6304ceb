// Bounded strings and vectors: never over their bound, never allocating, equal by content.
#include "core/base/bounded.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <type_traits>

namespace eciton {
namespace {

static_assert(std::is_trivially_copyable_v<BoundedString<7>>);
static_assert(std::is_trivially_copyable_v<BoundedVector<double, 3>>);
static_assert(BoundedVector<int, 3>::bound() == 3);

TEST(BoundedStringTest, TakesWhatFitsAndSaysSo) {
  BoundedString<5> text;
  EXPECT_TRUE(text.empty());
  EXPECT_TRUE(text.assign("chain"));
  EXPECT_EQ(text.view(), "chain");
  EXPECT_FALSE(text.assign("chains"));
  EXPECT_EQ(text.view(), "chain");
  EXPECT_EQ(text.size(), 5U);
}

TEST(BoundedStringTest, EndsWithAZeroEvenWhenFull) {
  BoundedString<5> text("chain link");
  EXPECT_STREQ(text.c_str(), "chain");
  text.assign("a");
  EXPECT_STREQ(text.c_str(), "a");
}

TEST(BoundedStringTest, LeavesNothingOfALongerTextBehind) {
  BoundedString<8> once_long("latched");
  once_long.assign("open");
  const BoundedString<8> always_short("open");
  EXPECT_EQ(once_long, always_short);
  EXPECT_EQ(std::string(once_long.c_str() + 4, 4), std::string(4, '\0'));
}

TEST(BoundedVectorTest, RefusesWhatDoesNotFit) {
  BoundedVector<int, 2> numbers;
  EXPECT_TRUE(numbers.push_back(1));
  EXPECT_TRUE(numbers.push_back(2));
  EXPECT_TRUE(numbers.full());
  EXPECT_FALSE(numbers.push_back(3));
  EXPECT_EQ(numbers.size(), 2U);
  EXPECT_EQ(numbers.back(), 2);
}

TEST(BoundedVectorTest, CutsASizeOverItsBound) {
  BoundedVector<int, 2> numbers;
  EXPECT_TRUE(numbers.resize(2));
  EXPECT_FALSE(numbers.resize(3));
  EXPECT_EQ(numbers.size(), 2U);
}

TEST(BoundedVectorTest, GrowsWithFreshElementsAfterShrinking) {
  BoundedVector<int, 3> numbers;
  for (const int k : {7, 8, 9}) numbers.push_back(k);
  numbers.resize(1);
  numbers.resize(3);
  EXPECT_EQ(numbers[0], 7);
  EXPECT_EQ(numbers[1], 0);
  EXPECT_EQ(numbers[2], 0);
}

TEST(BoundedVectorTest, IsARangeOfItsElementsOnly) {
  BoundedVector<int, 5> numbers;
  for (const int k : {1, 2, 3}) numbers.push_back(k);
  EXPECT_EQ(std::accumulate(numbers.begin(), numbers.end(), 0), 6);
  BoundedVector<int, 5> longer = numbers;
  EXPECT_EQ(longer, numbers);
  longer.push_back(0);  // equal to the unused element of the other
  EXPECT_FALSE(longer == numbers);
}

}  // namespace
}  // namespace eciton
