// Which claims are let in, by the claim alone and by who wrote it.
#include "services/radio/claim_guard.hpp"

#include <gtest/gtest.h>

namespace eciton::radio {
namespace {

constexpr std::uint64_t radio_2 = 22, other = 99;

GuardedClaim good() {
  return {.module = 2,
          .port = 1,
          .linked = true,
          .peer = 1,
          .peer_port = 0,
          .latched = true,
          .incarnation = 5,
          .sequence_number = 1};
}

class ClaimGuardTest : public ::testing::Test {
 protected:
  ClaimGuardTest() { guard_.hear_beacon(2, 5, radio_2); }
  ClaimFault judge(const GuardedClaim& claim, std::uint64_t origin = radio_2) const {
    return guard_.judge(claim, origin);
  }
  template <class Change>
  ClaimFault changed(Change&& change) const {
    GuardedClaim claim = good();
    change(claim);
    return judge(claim);
  }

  ClaimGuard guard_{{.own_id = 1, .ports = 2}};
};

TEST_F(ClaimGuardTest, LetsInAModulesOwnClaimsAndWithdrawals) {
  EXPECT_EQ(judge(good()), ClaimFault::count);
  EXPECT_EQ(changed([](GuardedClaim& c) { c.linked = c.latched = false, c.peer = 0, c.peer_port = 7; }),
            ClaimFault::count)
      << "what is void is not looked at";
}

TEST_F(ClaimGuardTest, RefusesClaimsThatNoModuleMakes) {
  EXPECT_EQ(changed([](GuardedClaim& c) { c.module = 0; }), ClaimFault::malformed);
  EXPECT_EQ(changed([](GuardedClaim& c) { c.module = 91; }), ClaimFault::malformed);
  EXPECT_EQ(changed([](GuardedClaim& c) { c.peer = 0; }), ClaimFault::malformed);
  EXPECT_EQ(changed([](GuardedClaim& c) { c.peer = 91; }), ClaimFault::malformed);
  EXPECT_EQ(changed([](GuardedClaim& c) { c.peer = 2; }), ClaimFault::malformed) << "itself";
  EXPECT_EQ(changed([](GuardedClaim& c) { c.latched = false; }), ClaimFault::malformed);
  EXPECT_EQ(changed([](GuardedClaim& c) { c.linked = false; }), ClaimFault::malformed);
  EXPECT_EQ(changed([](GuardedClaim& c) { c.incarnation = 0; }), ClaimFault::malformed);
  EXPECT_EQ(changed([](GuardedClaim& c) { c.sequence_number = 0; }), ClaimFault::malformed);
}

TEST_F(ClaimGuardTest, RefusesPortsThatDoNotExist) {
  EXPECT_EQ(changed([](GuardedClaim& c) { c.port = 2; }), ClaimFault::no_such_port);
  EXPECT_EQ(changed([](GuardedClaim& c) { c.peer_port = 2; }), ClaimFault::no_such_port);
}

TEST_F(ClaimGuardTest, RefusesWhatIsNotWrittenByTheModulesRadio) {
  EXPECT_EQ(judge(good(), other), ClaimFault::foreign_writer);
  EXPECT_EQ(judge(good(), 0), ClaimFault::count) << "not known contradicts nothing";
  EXPECT_EQ(changed([](GuardedClaim& c) { c.module = 1, c.peer = 2; }), ClaimFault::foreign_writer)
      << "ours do not come from outside";
}

TEST_F(ClaimGuardTest, FollowsARadioThatWasRestartedButNotOneThatOnlySendsUnderTheId) {
  guard_.hear_beacon(2, 5, other);
  EXPECT_EQ(judge(good(), other), ClaimFault::foreign_writer);
  guard_.hear_beacon(2, 6, 23);
  EXPECT_EQ(judge(good(), 23), ClaimFault::count);
  EXPECT_EQ(judge(good(), radio_2), ClaimFault::foreign_writer);
  guard_.hear_beacon(2, 5, radio_2);  // a late one
  EXPECT_EQ(judge(good(), 23), ClaimFault::count);
}

TEST_F(ClaimGuardTest, RefusesModulesThatWereNeverHeard) {
  EXPECT_EQ(changed([](GuardedClaim& c) { c.module = 3; }), ClaimFault::unknown_module);
  guard_.hear_beacon(0, 5, other), guard_.hear_beacon(1'000'000, 5, other);
  EXPECT_FALSE(guard_.knows(0) || guard_.knows(1'000'000));
}

TEST_F(ClaimGuardTest, CountsByKind) {
  guard_.refuse(ClaimFault::malformed);
  guard_.refuse(ClaimFault::no_such_port);
  guard_.refuse(ClaimFault::no_such_port);
  EXPECT_EQ(guard_.refused(ClaimFault::no_such_port), 2u);
  EXPECT_EQ(guard_.refused(ClaimFault::foreign_writer), 0u);
  EXPECT_EQ(guard_.refused(), 3u);
}

}  // namespace
}  // namespace eciton::radio
