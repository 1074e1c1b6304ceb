// A Result is a value or an Error, and start-up code turns the Error into BadInput.
#include "core/base/result.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace eciton {
namespace {

Result<int> half_of(int number) {
  if (number % 2 != 0) return Error{std::to_string(number) + " is odd"};
  return number / 2;
}

TEST(ResultTest, HoldsAValue) {
  const Result<int> half = half_of(8);
  ASSERT_TRUE(half.ok());
  EXPECT_TRUE(static_cast<bool>(half));
  EXPECT_EQ(*half, 4);
}

TEST(ResultTest, HoldsAnError) {
  const Result<int> half = half_of(7);
  ASSERT_FALSE(half.ok());
  EXPECT_EQ(half.error().message, "7 is odd");
}

TEST(ResultTest, GivesAwayAValueThatCannotBeCopied) {
  Result<std::unique_ptr<int>> owner = std::make_unique<int>(3);
  const std::unique_ptr<int> number = std::move(owner).value();
  EXPECT_EQ(*number, 3);
}

TEST(ResultTest, TellsAnErrorFromAValueOfTextLikeIt) {
  const Result<std::string> text = std::string("broken");
  EXPECT_TRUE(text.ok());
  EXPECT_EQ(text->size(), 6U);
}

TEST(ResultTest, BecomesBadInputAtStartUp) {
  EXPECT_EQ(value_or_throw(half_of(2)), 1);
  try {
    value_or_throw(half_of(3));
    FAIL() << "nothing was thrown";
  } catch (const BadInput& bad) {
    EXPECT_EQ(bad.error.message, "3 is odd");
  }
  EXPECT_NO_THROW(ok_or_throw(ok()));
  EXPECT_THROW(ok_or_throw(Error{"no"}), BadInput);
}

}  // namespace
}  // namespace eciton
