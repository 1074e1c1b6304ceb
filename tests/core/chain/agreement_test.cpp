// The agreement step by step: who decides, when the switch happens, and what silence and lateness do.
#include "core/chain/agreement.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace eciton::chain {
namespace {

constexpr TimePoint t0{100s};

/// Modules 1..n on a perfect radio, unless a test says otherwise. The male of k is in the female of k+1.
class AgreementTest : public testing::Test {
 protected:
  struct Module {
    Agreement agreement;
    ClaimTable claims;
    AnnouncementTable announcements;
    std::vector<PeerStatus> peers;
    Duration clock{};
    Module(std::uint32_t id, const StructureRule& rule) : agreement({.module = id, .incarnation = 1}, rule) {}
  };

  void create(std::uint32_t n) {
    for (std::uint32_t id = 1; id <= n; ++id) {
      modules.emplace_back(id, rule);
      for (std::uint32_t other = 1; other <= n; ++other) {
        if (other != id) modules.back().peers.push_back({other, true, Duration{}});
      }
      for (std::uint32_t port = 0; port < 2; ++port) tell_all({.module = id, .port = port, .incarnation = 1});
    }
    // Again, so that the first ones hear the last ones too.
    for (std::uint32_t id = 1; id <= n; ++id) {
      for (std::uint32_t port = 0; port < 2; ++port) tell_all({.module = id, .port = port, .incarnation = 1});
    }
  }
  Module& module(std::uint32_t id) { return modules[id - 1]; }
  void tell_all(const Claim& claim) {
    for (Module& m : modules) m.claims.join(claim);
  }
  void link(std::uint32_t male, std::uint32_t female) {
    ++sequence_number;
    tell_all({male, 0, female, 1, false, LatchStatus::latched, 1, sequence_number});
    tell_all({female, 1, male, 0, false, LatchStatus::latched, 1, sequence_number});
  }
  void restart(std::uint32_t id, std::uint64_t incarnation) {
    Module& m = module(id);
    std::destroy_at(&m.agreement);
    std::construct_at(&m.agreement, AgreementConfig{.module = id, .incarnation = incarnation}, rule);
    m.claims = {};
    m.announcements = {};
  }
  void update(std::uint32_t id) {
    Module& m = module(id);
    m.agreement.update(now + m.clock, m.claims, m.announcements, m.peers);
  }
  void hear(std::uint32_t to, std::uint32_t from) {
    module(to).announcements.join(module(from).agreement.announcement());
  }
  void round(Duration step = 10ms) {
    now += step;
    for (std::uint32_t id = 1; id <= modules.size(); ++id) update(id);
    for (std::uint32_t to = 1; to <= modules.size(); ++to) {
      for (std::uint32_t from = 1; from <= modules.size(); ++from) hear(to, from);
    }
  }
  void rounds(int count) {
    for (int k = 0; k < count; ++k) round();
  }
  /// So many modules, of which 1 and 2 fly as a pair; its epoch.
  std::uint64_t create_pair_among(std::uint32_t n) {
    create(n);
    round();
    link(1, 2);
    rounds(20);
    return active_epoch(1);
  }
  void set_fresh(std::uint32_t at, std::uint32_t peer, bool fresh) {
    for (PeerStatus& status : module(at).peers) {
      if (status.module == peer) status.fresh = fresh;
    }
  }
  std::uint64_t active_epoch(std::uint32_t id) { return module(id).agreement.active()->epoch; }

  ChainRule rule;
  TimePoint now = t0;
  std::uint64_t sequence_number = 0;
  std::vector<Module> modules;
};

TEST_F(AgreementTest, HoldsNoViewBeforeAModuleSpeaksForAllItsPorts) {
  Module alone(1, rule);
  alone.claims.join({.module = 1, .port = 0, .incarnation = 1});
  alone.agreement.update(now, alone.claims, alone.announcements, {});
  EXPECT_FALSE(alone.agreement.active());
  EXPECT_EQ(alone.agreement.obstacle(), Obstacle::ports_unknown);
  EXPECT_EQ(alone.agreement.announcement().phase, ViewPhase::none);
  alone.claims.join({.module = 1, .port = 1, .incarnation = 1});
  alone.agreement.update(now, alone.claims, alone.announcements, {});
  ASSERT_TRUE(alone.agreement.active());
  EXPECT_EQ(alone.agreement.active()->epoch, 0u);
  EXPECT_EQ(alone.agreement.announcement().phase, ViewPhase::active);
}

TEST_F(AgreementTest, SwitchesAllMembersAtTheStartTheBaseDecided) {
  create(3);
  round();
  link(1, 2);
  link(2, 3);
  round();  // all propose, and hear each other do so
  round();  // module 2, the base, decides
  const TimePoint start = now + 100ms;
  const Announcement& said = module(2).agreement.announcement();
  EXPECT_EQ(said.start, start);
  EXPECT_EQ(said.phase, ViewPhase::proposed);
  while (now < start - 10ms) {
    round();
    for (std::uint32_t id = 1; id <= 3; ++id) EXPECT_EQ(active_epoch(id), 0u);
  }
  round();
  for (std::uint32_t id = 1; id <= 3; ++id) {
    EXPECT_EQ(active_epoch(id), said.epoch);
    EXPECT_EQ(module(id).agreement.active_since(), start);
    EXPECT_EQ(module(id).agreement.announcement().phase, ViewPhase::active);
    EXPECT_EQ(module(id).agreement.announcement().start, start);
  }
}

TEST_F(AgreementTest, ConvertsTheStartToEachModulesClock) {
  create(2);
  module(2).clock = 5s;
  module(1).peers[0].clock_offset = 5s;
  module(2).peers[0].clock_offset = -5s;
  round();
  link(1, 2);
  round();
  round();  // 1 is the base
  const TimePoint start = now + 100ms;
  while (now < start) {
    EXPECT_EQ(active_epoch(1), 0u);
    EXPECT_EQ(active_epoch(2), 0u);
    round();
  }
  EXPECT_NE(active_epoch(1), 0u);
  EXPECT_EQ(active_epoch(1), active_epoch(2));
  EXPECT_EQ(module(2).agreement.active_since(), start);  // as it stands, on the base's clock
}

TEST_F(AgreementTest, WaitsAtMostAMarginWhateverItThinksOfTheClock) {
  create(2);
  module(2).clock = -1h;  // and 2 does not know
  module(2).peers[0].clock_offset.reset();
  round();
  link(1, 2);
  round();
  round();
  round();  // 2 has heard the start
  rounds(10);
  EXPECT_NE(active_epoch(2), 0u);
}

TEST_F(AgreementTest, SwitchesLateWhenTheStartIsHeardLate) {
  create(2);
  round();
  link(1, 2);
  round();
  for (int k = 0; k < 30; ++k) {  // 1 decides and switches; 2 hears nothing of it
    now += 10ms;
    update(1);
    update(2);
  }
  EXPECT_NE(active_epoch(1), 0u);
  EXPECT_EQ(active_epoch(2), 0u);
  EXPECT_EQ(module(2).agreement.obstacle(), Obstacle::no_start);
  hear(2, 1);
  now += 10ms;
  update(2);
  EXPECT_EQ(active_epoch(2), active_epoch(1));
  EXPECT_EQ(module(2).agreement.active_since(), module(1).agreement.active_since());
}

TEST_F(AgreementTest, PassesTheStartOnWhenTheBaseIsNotHeard) {
  create(3);
  round();
  link(1, 2);
  link(2, 3);
  round();
  now += 10ms;
  update(2);   // decides
  hear(1, 2);  // 3 never hears the base again
  now += 200ms;
  update(1);
  hear(3, 1);
  update(3);
  EXPECT_EQ(module(3).agreement.active_since(), module(2).agreement.announcement().start);
  EXPECT_EQ(active_epoch(3), module(2).agreement.announcement().epoch);
}

TEST_F(AgreementTest, DoesNotDecideWhileAMemberIsSilentAndFliesTheViewBefore) {
  const std::uint64_t pair = create_pair_among(3);
  ASSERT_NE(pair, 0u);
  set_fresh(2, 3, false);
  link(2, 3);
  rounds(50);
  EXPECT_EQ(active_epoch(1), pair);
  EXPECT_EQ(active_epoch(2), pair);
  EXPECT_EQ(active_epoch(3), 0u);
  EXPECT_EQ(module(2).agreement.obstacle(), Obstacle::member_silent);
  EXPECT_EQ(module(2).agreement.obstacle_module(), 3u);
  set_fresh(2, 3, true);
  rounds(20);
  EXPECT_NE(active_epoch(3), 0u);
  EXPECT_EQ(active_epoch(1), active_epoch(3));
}

TEST_F(AgreementTest, FollowsAMemberThatIsActiveEvenIfAnotherIsSilentHere) {
  create(3);
  round();
  set_fresh(1, 3, false);
  link(1, 2);
  link(2, 3);
  rounds(20);
  EXPECT_NE(active_epoch(2), 0u);
  EXPECT_EQ(active_epoch(1), active_epoch(2));
}

TEST_F(AgreementTest, DoesNotStartWithASilentMemberThatNobodyHasSeenActive) {
  create(2);
  round();
  link(1, 2);
  round();
  round();  // decided
  set_fresh(1, 2, false);
  set_fresh(2, 1, false);
  rounds(50);
  EXPECT_EQ(active_epoch(1), 0u);
  EXPECT_EQ(active_epoch(2), 0u);
}

TEST_F(AgreementTest, KeepsTheActiveViewThroughSilence) {
  const std::uint64_t pair = create_pair_among(2);
  set_fresh(1, 2, false);
  rounds(1000);
  EXPECT_EQ(active_epoch(1), pair);
  EXPECT_EQ(module(1).agreement.freshness_of(2, module(1).peers), Freshness::silent);
}

TEST_F(AgreementTest, AgreesAnewWhenAMemberWithdraws) {
  create(3);
  round();
  link(1, 2);
  link(2, 3);
  rounds(20);
  const std::uint64_t all = active_epoch(1);
  tell_all({.module = 3, .port = 1, .incarnation = 1, .sequence_number = 99});
  round();
  EXPECT_EQ(active_epoch(3), 0u) << "a single module needs nobody's agreement";
  EXPECT_EQ(active_epoch(1), all);
  EXPECT_EQ(module(1).agreement.freshness_of(3, module(1).peers), Freshness::left);
  rounds(20);
  EXPECT_NE(active_epoch(1), all);
  EXPECT_EQ(active_epoch(1), active_epoch(2));
  EXPECT_EQ(module(1).agreement.active()->members.size(), 2u);
}

TEST_F(AgreementTest, KeepsTheActiveViewWhenTheLinksCloseToARing) {
  const std::uint64_t pair = create_pair_among(2);
  link(2, 1);
  rounds(20);
  EXPECT_EQ(active_epoch(1), pair);
  EXPECT_EQ(module(1).agreement.obstacle(), Obstacle::structure_refused);
  EXPECT_EQ(module(1).agreement.refusal(), Refusal::ring);
}

TEST_F(AgreementTest, TakesNothingFromAModuleThatComesBackAsItsOldIncarnation) {
  const std::uint64_t pair = create_pair_among(3);
  ASSERT_NE(pair, 0u);
  // 2 comes back counting from the start under the same incarnation: its words are older than what stands.
  restart(2, 1);
  for (std::uint32_t port = 0; port < 2; ++port) tell_all({.module = 2, .port = port, .incarnation = 1});
  rounds(50);
  EXPECT_EQ(active_epoch(1), pair) << "an old word undid a link";
  EXPECT_EQ(module(1).agreement.held()->epoch, pair);
  EXPECT_EQ(active_epoch(2), 0u);
  EXPECT_EQ(module(1).claims.find(2, 1)->sequence_number, sequence_number);
  // As a new one it is believed, and agrees anew once it has spoken for both ports.
  restart(2, 2);
  module(2).claims.join(module(1).claims);
  tell_all({.module = 2, .port = 0, .incarnation = 2, .sequence_number = 1});
  rounds(20);
  EXPECT_FALSE(module(2).agreement.active());
  EXPECT_EQ(active_epoch(1), pair);
  tell_all({2, 1, 1, 0, false, LatchStatus::latched, 2, 2});
  rounds(20);
  EXPECT_NE(active_epoch(1), pair);
  EXPECT_EQ(module(1).agreement.active(), module(2).agreement.active());
  EXPECT_EQ(module(1).agreement.active()->members.size(), 2u);
}

TEST_F(AgreementTest, FliesNoLinkThatOneLatchContradicts) {
  const std::uint64_t pair = create_pair_among(3);
  // 3 claims the port that 1 is in, and one that is open: neither latch bears it out.
  tell_all({3, 0, 2, 1, false, LatchStatus::latched, 1, 1});
  tell_all({3, 1, 2, 0, false, LatchStatus::latched, 1, 2});
  rounds(20);
  EXPECT_EQ(active_epoch(1), pair);
  EXPECT_EQ(active_epoch(2), pair);
  EXPECT_EQ(active_epoch(3), 0u);
  // A claim whose own latch is not closed holds nothing, whatever it names.
  tell_all({2, 0, 3, 1, false, LatchStatus::ready, 1, 50});
  rounds(20);
  EXPECT_EQ(module(2).agreement.active()->members.size(), 2u);
  EXPECT_EQ(active_epoch(3), 0u);
}

TEST_F(AgreementTest, AnnouncesOnlyWhatChanged) {
  create(2);
  round();
  const std::uint64_t sequence = module(1).agreement.announcement().sequence_number;
  rounds(100);
  EXPECT_EQ(module(1).agreement.announcement().sequence_number, sequence);
}

TEST(FreshnessTest, IsLostSoonerNearbyThanFarAway) {
  EXPECT_TRUE(is_fresh(200ms, true, {}));
  EXPECT_FALSE(is_fresh(260ms, true, {}));
  EXPECT_TRUE(is_fresh(4s, false, {}));
  EXPECT_FALSE(is_fresh(5100ms, false, {}));
}

}  // namespace
}  // namespace eciton::chain
