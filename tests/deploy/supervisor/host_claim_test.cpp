// Claims on what a host has once.
#include "deploy/supervisor/host_claim.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <optional>

namespace eciton::deploy {
namespace {

TEST(HostClaimTest, IsExclusiveNamesItsHolderAndEndsWithIt) {
  const std::string what = "test thing " + std::to_string(::getpid());
  std::optional<HostClaim> first;
  {
    auto claim = HostClaim::take(what);
    ASSERT_TRUE(claim.ok()) << claim.error().message;
    first.emplace(std::move(claim).value());
  }
  for (int k = 0; k < 20; ++k) {
    const auto second = HostClaim::take(what);
    ASSERT_FALSE(second.ok());
    EXPECT_EQ(second.error().message,
              what + " is already in use on this host by process " + std::to_string(::getpid()));
  }
  EXPECT_TRUE(HostClaim::take(what + " else").ok());
  first.reset();
  EXPECT_TRUE(HostClaim::take(what).ok());
}

}  // namespace
}  // namespace eciton::deploy
