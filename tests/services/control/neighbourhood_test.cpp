// Whom a module keeps its distance from: not those it is linked with, docks with or stood beside, but the others.
#include "services/control/control_service_neighbourhood.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "services/control/hand_over.hpp"

namespace eciton::control {
namespace {

constexpr double distance_m = 1.25;
const robot::Vector3 here(0, 0, 1.5);

class NeighbourhoodTest : public ::testing::Test {
 protected:
  void place(std::uint32_t id, double x) {
    msg::ModuleState state;
    state.module_id = id;
    state.p_WM_m = {x, 0, 1.5};
    hood_.hear(state, now_);
    msg::Beacon beacon;
    beacon.module_id = id;
    beacon.flight_mode = msg::FlightMode::hover;
    hood_.hear(beacon);
  }
  void chain(std::uint32_t id, std::uint64_t epoch, std::initializer_list<std::uint32_t> members) {
    msg::ChainView view;
    view.module_id = id;
    view.active = true;
    view.active_epoch = epoch;
    for (const std::uint32_t member : members) view.members.push_back(member);
    hood_.hear(view);
  }
  void docks(std::uint32_t id, std::uint32_t with, msg::DockingPhase phase) {
    msg::DockingState docking;
    docking.module_id = id;
    docking.peer_id = with;
    docking.phase = phase;
    hood_.hear(docking, now_);
  }
  std::size_t clear_of() { return hood_.keep_clear_of(here, distance_m, now_).size(); }

  Neighbourhood hood_{1};
  TimePoint now_ = TimePoint{} + std::chrono::seconds(100);
};

TEST_F(NeighbourhoodTest, OfStrangersItKeepsClearAndSharesTheWayWithThoseThatFlyAlone) {
  place(2, 2);
  place(3, -2);
  chain(3, 77, {3, 4});
  const auto others = hood_.keep_clear_of(here, distance_m, now_);
  ASSERT_EQ(others.size(), 2u);
  EXPECT_TRUE(others[0].gives_way);
  EXPECT_FALSE(others[1].gives_way) << "a chain goes straight on";
}

TEST_F(NeighbourhoodTest, WhoStandsOnTheGroundDoesNotGiveWay) {
  place(2, 2);
  msg::Beacon beacon;
  beacon.module_id = 2;
  beacon.flight_mode = msg::FlightMode::armed;
  hood_.hear(beacon);
  EXPECT_FALSE(hood_.keep_clear_of(here, distance_m, now_)[0].gives_way);
}

TEST_F(NeighbourhoodTest, ThePartnerOfADockingAndItsChainAreLeftOutWhoeverSaysSo) {
  place(2, 1);
  place(3, 1.8);
  place(4, -2);
  chain(2, 5, {2, 3});
  chain(3, 5, {2, 3});
  EXPECT_EQ(clear_of(), 3u);
  docks(1, 2, msg::DockingPhase::approach);
  EXPECT_EQ(clear_of(), 1u) << "module 4 is still there";
  docks(1, 0, msg::DockingPhase::idle);
  now_ += std::chrono::seconds(11);
  place(2, 2);
  place(3, 2.8);
  place(4, -2);
  EXPECT_EQ(clear_of(), 3u);
  docks(2, 1, msg::DockingPhase::align);
  EXPECT_EQ(clear_of(), 1u);
}

TEST_F(NeighbourhoodTest, ThoseWhoPartAreLeftOutUntilTheyAreApart) {
  place(2, 0.8);
  chain(1, 9, {1, 2});
  chain(2, 9, {1, 2});
  EXPECT_EQ(clear_of(), 0u);
  chain(1, 10, {1});
  chain(2, 11, {2});
  EXPECT_EQ(clear_of(), 0u) << "just undocked: not to be thrown apart";
  place(2, 1.3);
  EXPECT_EQ(clear_of(), 1u);
  place(2, 0.8);
  EXPECT_EQ(clear_of(), 1u) << "and not let in again";
}

TEST_F(NeighbourhoodTest, PartingHasATimeLimit) {
  place(2, 0.8);
  docks(1, 2, msg::DockingPhase::recover);
  EXPECT_EQ(clear_of(), 0u);
  docks(1, 2, msg::DockingPhase::idle);
  now_ += std::chrono::seconds(11);
  EXPECT_EQ(clear_of(), 1u);
}

TEST_F(NeighbourhoodTest, NeighboursOnTheGroundStayWhereTheyAreAtATakeOff) {
  place(2, 1.0);
  place(3, 2.0);
  hood_.accept_those_near(here, distance_m, now_);
  EXPECT_EQ(clear_of(), 1u);
}

TEST_F(NeighbourhoodTest, WhoIsSilentForAMinuteIsForgotten) {
  place(2, 2);
  now_ += std::chrono::seconds(30);
  EXPECT_NEAR(hood_.keep_clear_of(here, distance_m, now_)[0].age_s, 30, 1e-9);
  now_ += std::chrono::seconds(31);
  EXPECT_EQ(clear_of(), 0u);
}

TEST_F(NeighbourhoodTest, AStateThatIsNoNumberIsNotTaken) {
  place(2, 2);
  msg::ModuleState state;
  state.module_id = 2;
  state.p_WM_m = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  hood_.hear(state, now_);
  EXPECT_EQ(hood_.keep_clear_of(here, distance_m, now_)[0].p_WM.x(), 2);
}

TEST_F(NeighbourhoodTest, MoreThanFitPushOutTheOneSilentLongest) {
  for (std::uint32_t id = 2; id < 2 + robot::members_max; ++id) {
    now_ += std::chrono::milliseconds(1);
    place(id, 3);
  }
  now_ += std::chrono::milliseconds(1);
  place(90, 2);
  EXPECT_EQ(clear_of(), robot::members_max);
  EXPECT_EQ(hood_.find(2), nullptr);
  EXPECT_NE(hood_.find(90), nullptr);
}

TEST(HandOverTest, WhatIsInForceDoesNotStepAndWhatIsLeftFadesByTheClock) {
  HandOver hand_over(1.0);
  const robot::Wrench before{{3, 0, -1}, {0, 0.2, 0}}, after{{0, 1, 0}, {0, 0, 0}};
  EXPECT_EQ(hand_over.update(before, 0.002).force, before.force) << "with nothing to hand over it adds nothing";
  hand_over.begin();
  EXPECT_LT((hand_over.update(after, 0.002).force - before.force).norm(), 1e-12);
  robot::Wrench now;
  for (int k = 0; k < 500; ++k) now = hand_over.update(after, 0.002);
  EXPECT_NEAR((now.force - after.force).norm(), (before.force - after.force).norm() * std::exp(-1.0), 1e-9);
  hand_over.reset();
  EXPECT_EQ(hand_over.update({}, 0.002).force.norm(), 0);
}

}  // namespace
}  // namespace eciton::control
