// A broken contract ends the process on the ground, and goes to the installed handler in the air.
#include "core/base/contract.hpp"

#include <gtest/gtest.h>

#include <string>

namespace eciton {
namespace {

std::string last_message;
void remember(const Violation& violation) noexcept { last_message = violation.message; }

TEST(ContractTest, GoesToTheHandlerAndReturns) {
  const ViolationHandler before = set_violation_handler(&remember);
  const int rotors = 0;
  ECITON_EXPECT(rotors > 0, "an airframe has rotors");
  EXPECT_EQ(last_message, "an airframe has rotors");
  last_message.clear();
  ECITON_EXPECT(rotors == 0, "this one holds");
  EXPECT_EQ(last_message, "");
  EXPECT_EQ(set_violation_handler(before), &remember);
}

TEST(ContractDeathTest, EndsTheProcessByDefaultAndSaysWhere) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_DEATH(ECITON_EXPECT(1 + 1 == 3, "sums hold"), "contract_test.cpp:[0-9]+: contract broken: sums hold");
}

}  // namespace
}  // namespace eciton
