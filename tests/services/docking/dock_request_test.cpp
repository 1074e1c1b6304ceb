// Refusals with their reasons, and which ports a docking takes.
#include "services/docking/dock_request.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace eciton::docking {
namespace {

Candidate ready(std::uint32_t module) {
  return {.module = module, .known = true, .fresh = true, .flying = true, .docking = false, .zeroed = true};
}

DockAnswer judge(const Candidate& follower, const Candidate& target, bool same_chain, bool ports_fit) {
  return refuse_dock({&follower, 1}, {&target, 1}, same_chain, ports_fit);
}

TEST(RefuseDockTest, AcceptsTwoReadyModules) {
  EXPECT_EQ(judge(ready(1), ready(2), false, true).refusal, DockRefusal::none);
}

TEST(RefuseDockTest, SaysWhichModuleStandsInTheWayAndWhatWouldBeRight) {
  Candidate landed = ready(2), unknown = ready(3), silent = ready(4), busy = ready(5), raw = ready(6);
  landed.flying = false;
  unknown.known = false;
  silent.fresh = false;
  busy.docking = true;
  raw.zeroed = false;
  EXPECT_EQ(judge(ready(1), landed, false, true).text().view(), "module 2 is not flying: take off first");
  EXPECT_EQ(judge(landed, ready(1), false, true).module, 2u);
  EXPECT_EQ(judge(ready(1), unknown, false, true).refusal, DockRefusal::unknown_module);
  EXPECT_EQ(judge(ready(1), silent, false, true).refusal, DockRefusal::silent);
  EXPECT_EQ(judge(ready(1), busy, false, true).refusal, DockRefusal::already_docking);
  EXPECT_EQ(judge(raw, ready(1), false, true).refusal, DockRefusal::not_zeroed);
  EXPECT_EQ(judge(ready(1), ready(1), false, true).refusal, DockRefusal::same_module);
  EXPECT_EQ(judge(ready(1), ready(2), true, true).refusal, DockRefusal::ring);
  EXPECT_EQ(judge(ready(1), ready(2), false, false).refusal, DockRefusal::ports_taken);
}

TEST(RefuseDockTest, JudgesEveryMemberOfBothChains) {
  const std::vector follower{ready(1), ready(2)};
  for (const bool on_target : {true, false}) {
    std::vector mates{ready(3), ready(4)};
    const auto judge_mates = [&] {
      return on_target ? refuse_dock(follower, mates, false, true) : refuse_dock(mates, follower, false, true);
    };
    EXPECT_EQ(judge_mates().refusal, DockRefusal::none);
    mates[1].docking = true;
    EXPECT_EQ(judge_mates().refusal, DockRefusal::already_docking);
    EXPECT_EQ(judge_mates().module, 4u);
    mates[0].flying = false;
    EXPECT_EQ(judge_mates().module, 3u) << "the one that was named counts first";
    mates = {ready(3), ready(4)};
    mates[1].fresh = false;
    EXPECT_EQ(judge_mates().refusal, DockRefusal::silent);
    mates[1] = ready(4);
    mates[1].zeroed = false;
    EXPECT_EQ(judge_mates().refusal, DockRefusal::not_zeroed);
  }
}

TEST(RefuseDockTest, FitsEveryReasonIntoAGoalStatus) {
  for (int k = 0; k <= static_cast<int>(DockRefusal::ports_taken); ++k) {
    const auto text = DockAnswer{static_cast<DockRefusal>(k), 4294967295u}.text();
    EXPECT_LT(text.size(), 127u);
    EXPECT_NE(text.view(), "unknown");
  }
}

FreePort port(std::uint32_t module, PortKind kind, const Vector3& p_W) {
  return {module, kind == PortKind::male ? 0u : 1u, kind, {p_W, robot::Matrix3::Identity()}};
}

TEST(ChoosePortsTest, TakesTheEndOfTheTargetTheFollowerIsNearTo) {
  const std::vector target{port(1, PortKind::male, {.4, 0, 0}), port(1, PortKind::female, {-.4, 0, 0})};
  const std::vector ahead{port(2, PortKind::male, {2.4, 0, 0}), port(2, PortKind::female, {1.6, 0, 0})};
  const std::vector behind{port(2, PortKind::male, {-1.6, 0, 0}), port(2, PortKind::female, {-2.4, 0, 0})};
  const auto onto_male = choose_ports(ahead, target, 0.3);
  ASSERT_TRUE(onto_male);
  EXPECT_EQ(onto_male->target.kind, PortKind::male);
  EXPECT_EQ(onto_male->follower.kind, PortKind::female);
  const auto into_female = choose_ports(behind, target, 0.3);
  ASSERT_TRUE(into_female);
  EXPECT_EQ(into_female->target.kind, PortKind::female);
  EXPECT_EQ(into_female->follower.kind, PortKind::male);
}

TEST(ChoosePortsTest, TakesTheFartherEndWhenOnlyThatIsFree) {
  const std::vector target{port(1, PortKind::female, {-.4, 0, 0})};
  const std::vector ahead{port(2, PortKind::male, {2.4, 0, 0}), port(2, PortKind::female, {1.6, 0, 0})};
  const auto choice = choose_ports(ahead, target, 0.3);
  ASSERT_TRUE(choice);
  EXPECT_EQ(choice->follower.kind, PortKind::male);
}

TEST(ChoosePortsTest, FindsNoneWhereNoneFits) {
  const std::vector target{port(1, PortKind::female, {-.4, 0, 0})};
  const std::vector follower{port(2, PortKind::female, {1.6, 0, 0})};
  EXPECT_FALSE(choose_ports(follower, target, 0.3));
  EXPECT_FALSE(choose_ports({}, target, 0.3));
}

TEST(ChoosePortsTest, UsesTheEndsOfTwoChains) {
  // Chain 1-2 at the origin: its male end is module 2's, its female end module 1's; module 3 flies behind it.
  const std::vector target{port(2, PortKind::male, {.4, 0, 0}), port(1, PortKind::female, {-1.2, 0, 0})};
  const std::vector follower{port(3, PortKind::male, {-2, 0, 0}), port(3, PortKind::female, {-2.8, 0, 0})};
  const auto choice = choose_ports(follower, target, 0.3);
  ASSERT_TRUE(choice);
  EXPECT_EQ(choice->target.module, 1u);
}

}  // namespace
}  // namespace eciton::docking
