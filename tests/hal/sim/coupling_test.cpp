// Latches, magnets, welds and the contact truth: when a latch closes, what it holds, how it lets go, and
// the wrench in it against statics by hand.
#include <gtest/gtest.h>

#include "tests/hal/sim/pilot.hpp"
#include "tests/hal/sim/worlds.hpp"

namespace eciton::hal::sim {
namespace {

using robot::Vector3;
using robot::Wrench;

void engage(std::vector<Pilot>& pilots, LatchCommand command) {
  for (Pilot& pilot : pilots) pilot.frame.latches = {command, command, LatchCommand::hold, LatchCommand::hold};
}

/// Two modules linked and at rest, each on its pilot.
struct LinkedPair {
  explicit LinkedPair(const WorldConfig& config = still_world())
      : world(config, robot::legion(), nose_to_tail({0.001, 0, 0})), pilots{{world, 1}, {world, 2}} {
    engage(pilots, LatchCommand::engage);
    pilots[1].goal.x() -= 0.001;
    for (Pilot& pilot : pilots) pilot.integral_gain = 0;
    fly(world, pilots, 2);
  }
  World world;
  std::vector<Pilot> pilots;
};

struct Seat {
  Vector3 p_PF_m;
  double yaw_rad;
  bool closes;
};

TEST(LatchTest, ClosesOnGeometryAlone) {
  // Axial < 6 mm, radial < 8 mm, angle < 0.2 rad; looked at after one step, before anything has moved.
  for (const Seat& seat :
       {Seat{{0.0055, 0, 0}, 0, true}, Seat{{0.0065, 0, 0}, 0, false}, Seat{{-0.0055, 0, 0}, 0, true},
        Seat{{0, 0.0075, 0}, 0, true}, Seat{{0, 0, -0.0085}, 0, false}, Seat{{0, 0.006, 0.006}, 0, false},
        Seat{{0, 0, 0}, 0.19, true}, Seat{{0, 0, 0}, 0.21, false}}) {
    World world(still_world(), robot::legion(), nose_to_tail(seat.p_PF_m, seat.yaw_rad));
    for (const std::uint32_t id : {1U, 2U}) world.actuate(id, hover_frame(LatchCommand::engage));
    world.advance(world.now() + 1ms);
    EXPECT_EQ(world.latched_links(), seat.closes ? 1 : 0) << seat.p_PF_m.transpose() << " yaw " << seat.yaw_rad;
    const LatchReading expected = seat.closes ? LatchReading::latched : LatchReading::ready;
    EXPECT_EQ(world.sense(1).latches[0], expected);
    EXPECT_EQ(world.sense(2).latches[1], expected);
    EXPECT_EQ(world.sense(1).latches[1], LatchReading::ready);  // module 1's female port is free
  }
}

TEST(LatchTest, NeedsBothSidesEngaged) {
  World world(still_world(), robot::legion(), nose_to_tail({0.001, 0, 0}));
  world.actuate(1, hover_frame(LatchCommand::engage));
  world.actuate(2, hover_frame(LatchCommand::hold));
  world.advance(world.now() + 5ms);
  EXPECT_EQ(world.latched_links(), 0);
  EXPECT_EQ(world.sense(1).latches[0], LatchReading::ready);
  EXPECT_EQ(world.sense(2).latches[1], LatchReading::open);
  world.actuate(2, hover_frame(LatchCommand::engage));
  world.advance(world.now() + 5ms);
  EXPECT_EQ(world.latched_links(), 1);
}

TEST(LatchTest, HoldsWhenItsPowerGoes) {
  LinkedPair pair;
  ActuatorFrame frame;  // nothing powered, latches on hold
  pair.world.actuate(1, frame);
  pair.world.cut(2);
  pair.world.advance(pair.world.now() + 100ms);
  EXPECT_EQ(pair.world.latched_links(), 1);
}

TEST(LatchTest, ConeGuidesAnApproachWithOffsetIntoTheLatch) {
  for (const double speed_m_s : {0.1, 0.3, 1.0}) {
    for (const Vector3& offset : {Vector3(0.1, 0.03, 0), Vector3(0.1, -0.02, 0.03), Vector3(0.1, 0, -0.04)}) {
      WorldConfig config;  // honest, with wakes
      World world(config, robot::legion(), nose_to_tail(offset));
      std::vector<Pilot> pilots{{world, 1}, {world, 2}};
      engage(pilots, LatchCommand::engage);
      const double x = pilots[1].goal.x();
      double speed_m_s_max = 0, force_N_max = 0;
      fly(world, pilots, 3, [&](double t) {
        pilots[1].goal.x() = std::max(x - speed_m_s * t, x - 0.15);
        if (world.latched_links() > 0) pilots[1].goal = pilots[0].goal + legion_port(0).p - legion_port(1).p;
        speed_m_s_max = std::max(speed_m_s_max, world.truth_pose(2).v_WB_m_s.norm());
        if (const auto contact = world.truth_contact(1, 0)) {
          force_N_max = std::max(force_N_max, contact->wrench_P_W.force.norm());
        }
      });
      EXPECT_EQ(world.latched_links(), 1) << speed_m_s << " m/s, offset " << offset.transpose();
      EXPECT_LT(speed_m_s_max, 2.0);
      EXPECT_LT(force_N_max, speed_m_s <= 0.3 ? 60.0 : 150.0) << speed_m_s << " m/s, offset " << offset.transpose();
      EXPECT_FALSE(world.fault());
    }
  }
}

TEST(LatchTest, GapUnderThirtyNewtonsStaysBelowTwentyMicrometres) {
  LinkedPair pair;
  EXPECT_LT(pair.world.truth_contact(1, 0)->gap_m, 2e-6);
  pair.world.set_external_wrench(1, {.force = {-30, 0, 0}});
  pair.world.set_external_wrench(2, {.force = {30, 0, 0}});
  fly(pair.world, pair.pilots, 1);
  const TruthContact contact = *pair.world.truth_contact(1, 0);
  EXPECT_NEAR(contact.wrench_P_W.force.x(), -30, 0.1);  // module 1 holds module 2 back
  EXPECT_GT(contact.gap_m, 1e-6);
  EXPECT_LT(contact.gap_m, 20e-6);
}

TEST(ContactTruthTest, AgreesWithStaticsByHand) {
  // On 1 the wrench (f, m1) about r1, on 2 (-f, m2) about r2, in balance: m1 + m2 + (r1 - r2) x f = 0, so
  // the pilots have nothing to do. Module 2 alone: F = f, M about P: M + m2 + (P - r2) x F = 0.
  LinkedPair pair;
  const robot::Pose X1 = pair.world.truth_pose(1).X_WB, X2 = pair.world.truth_pose(2).X_WB;
  const Vector3 r1 = X1.p, r2 = X2.p, f(2, 1.5, 3), m1(0.2, -0.5, 0.1);
  const Vector3 m2 = -m1 - (r1 - r2).cross(f);
  const Wrench before = pair.world.truth_contact(1, 0)->wrench_P_W;
  pair.world.set_external_wrench(1, {.force = f, .moment = m1});
  pair.world.set_external_wrench(2, {.force = -f, .moment = m2});
  fly(pair.world, pair.pilots, 2);
  const TruthContact contact = *pair.world.truth_contact(1, 0);
  EXPECT_EQ(contact.module_id, 1U);
  EXPECT_EQ(contact.peer_id, 2U);
  EXPECT_EQ(contact.peer_port, 1U);
  EXPECT_LT((contact.p_W_m - (X1 * legion_port(0).p)).norm(), 5e-3);
  const Vector3 moment = -m2 - (contact.p_W_m - r2).cross(f);
  // The joint servos give way a little (8 mrad per Nm) and the pilots answer that.
  EXPECT_LT((contact.wrench_P_W.force - before.force - f).norm(), 0.15) << contact.wrench_P_W.force.transpose();
  EXPECT_LT((contact.wrench_P_W.moment - before.moment - moment).norm(), 0.08)
      << contact.wrench_P_W.moment.transpose() << " by hand " << moment.transpose();
}

TEST(ContactTruthTest, CarriesTheWholeWeightOfAModuleWithoutThrust) {
  // Newton for the hanging module: at every instant the contact is what its motion asks for beyond gravity.
  LinkedPair pair;
  pair.world.cut(2);
  for (int k = 0; k < 100; ++k) {
    pair.pilots[0].act();
    pair.world.advance(pair.world.now() + 2ms);
  }
  pair.world.advance(pair.world.now() + 1ms);
  const Vector3 v = pair.world.truth_pose(2).v_WM_m_s;
  double thrust_N = 0;
  pair.world.advance(pair.world.now() + 1ms);
  const Vector3 a = (pair.world.truth_pose(2).v_WM_m_s - v) / 1e-3;
  for (std::size_t k = 0; k < 3; ++k) thrust_N += pair.world.sense(2).rotors[k].thrust_N;
  const Vector3 up = pair.world.truth_pose(2).X_WB.R.col(2);
  const Vector3 expected = 3.915 * (a + Vector3(0, 0, 9.81)) - thrust_N * up;
  EXPECT_LT((pair.world.truth_contact(1, 0)->wrench_P_W.force - expected).norm(), 0.01 * expected.norm())
      << pair.world.truth_contact(1, 0)->wrench_P_W.force.transpose() << " against " << expected.transpose();
}

TEST(ContactTruthTest, IsNothingWhereNothingIsLinked) {
  World world(still_world(), robot::legion(), nose_to_tail({0.5, 0, 0}));
  EXPECT_FALSE(world.truth_contact(1, 0));
  EXPECT_FALSE(world.truth_contact(1, 1));  // a female port has no contact of its own
}

TEST(LatchTest, ReleaseByEitherSideOpensAndLetsThePartsGoSmoothly) {
  for (const std::size_t who : {0U, 1U}) {
    LinkedPair pair;
    pair.pilots[who].frame.latches = {LatchCommand::release, LatchCommand::release};
    const double x = pair.pilots[1].goal.x();
    double speed_m_s_max = 0;
    fly(pair.world, pair.pilots, 2, [&](double t) {
      pair.pilots[1].goal.x() = x + std::min(0.3, 0.2 * t);
      speed_m_s_max = std::max(speed_m_s_max, pair.world.truth_pose(2).v_WB_m_s.norm());
    });
    EXPECT_EQ(pair.world.latched_links(), 0);
    EXPECT_FALSE(pair.world.truth_contact(1, 0));
    EXPECT_LT(speed_m_s_max, 0.4);
    EXPECT_NEAR((pair.world.truth_pose(2).p_WM_m - pair.world.truth_pose(1).p_WM_m).x(), 0.806 + 0.3, 0.02);
    EXPECT_EQ(pair.world.sense(who == 0 ? 1 : 2).latches[who == 0 ? 0 : 1], LatchReading::open);
    EXPECT_EQ(pair.world.sense(who == 0 ? 2 : 1).latches[who == 0 ? 1 : 0], LatchReading::ready);

    // ... and the cone is there again for the next docking.
    engage(pair.pilots, LatchCommand::engage);
    pair.pilots[1].goal.y() += 0.02;
    fly(pair.world, pair.pilots, 3, [&](double t) { pair.pilots[1].goal.x() = x + std::max(-0.05, 0.3 - 0.2 * t); });
    EXPECT_EQ(pair.world.latched_links(), 1);
  }
}

TEST(LatchTest, DoesNotCloseAgainBeforeThePartsHaveLeftEachOther) {
  LinkedPair pair;
  engage(pair.pilots, LatchCommand::release);
  fly(pair.world, pair.pilots, 0.1);
  engage(pair.pilots, LatchCommand::engage);
  fly(pair.world, pair.pilots, 0.5);
  EXPECT_EQ(pair.world.latched_links(), 0);
}

TEST(LatchTest, BrokenWeldReportsButDoesNotHold) {
  WorldConfig config = still_world();
  config.break_what = "weld-off";
  LinkedPair pair(config);
  EXPECT_EQ(pair.world.sense(1).latches[0], LatchReading::latched);
  EXPECT_EQ(pair.world.sense(2).latches[1], LatchReading::latched);
  EXPECT_EQ(pair.world.latched_links(), 0);
  const double x = pair.pilots[1].goal.x();
  fly(pair.world, pair.pilots, 2, [&](double t) { pair.pilots[1].goal.x() = x + std::min(0.3, 0.2 * t); });
  EXPECT_GT((pair.world.truth_pose(2).p_WM_m - pair.world.truth_pose(1).p_WM_m).x(), 1.0);
  EXPECT_EQ(pair.world.sense(1).latches[0], LatchReading::latched);
}

TEST(LatchTest, AnyMaleFitsAnyFemaleAndChainsForm) {
  // Module 3's male in module 1's female, module 1's in module 2's: the chain 3, 1, 2.
  const Vector3 pitch = legion_port(0).p - legion_port(1).p;
  std::vector<ModuleStart> starts = nose_to_tail({0.001, 0, 0});
  starts.push_back({.id = 3, .p_WB_m = {-pitch.x() - 0.001, -pitch.y(), 1.5 - pitch.z()}, .hovering = true});
  World world(still_world(), robot::legion(), starts);
  std::vector<Pilot> pilots{{world, 1}, {world, 2}, {world, 3}};
  engage(pilots, LatchCommand::engage);
  fly(world, pilots, 1);
  EXPECT_EQ(world.latched_links(), 2);
  EXPECT_EQ(world.truth_contact(1, 0)->peer_id, 2U);
  EXPECT_EQ(world.truth_contact(3, 0)->peer_id, 1U);
  EXPECT_FALSE(world.truth_contact(2, 0));
}

TEST(LatchTest, LinkedPairLandsLiesStillAndTakesOffAgain) {
  WorldConfig config;  // honest: uneven weights, two bodies on six feet
  World world(config, robot::legion(), nose_to_tail({0.001, 0, 0}));
  std::vector<Pilot> pilots{{world, 1}, {world, 2}};
  engage(pilots, LatchCommand::engage);
  const auto move = [&](double height_m, double speed_m_s, double duration_s) {
    const std::array<double, 2> z{pilots[0].goal.z(), pilots[1].goal.z()};
    fly(world, pilots, duration_s, [&](double t) {
      for (std::size_t i = 0; i < 2; ++i) {
        pilots[i].goal.z() = z[i] + std::copysign(std::min(std::abs(height_m), speed_m_s * t), height_m);
      }
    });
  };
  fly(world, pilots, 1);
  move(-1.45, 0.5, 4);
  for (const std::uint32_t id : {1U, 2U}) world.cut(id);
  world.advance(world.now() + 1s);
  double speed_m_s_max = 0;
  for (int k = 0; k < 500; ++k) {
    world.advance(world.now() + 1ms);
    speed_m_s_max = std::max(speed_m_s_max, world.truth_pose(1).v_WB_m_s.norm());
  }
  EXPECT_LT(speed_m_s_max, 1e-3);
  EXPECT_NEAR(world.truth_pose(2).X_WB.p.z(), 0.13, 2e-3);
  move(1.0, 0.4, 4);
  EXPECT_GT(world.truth_pose(1).X_WB.p.z(), 0.8);
  EXPECT_EQ(world.latched_links(), 1);
  EXPECT_FALSE(world.fault());
}

TEST(LatchTest, SixteenModulesLinkAndFallTogether) {
  const Vector3 pitch = legion_port(0).p - legion_port(1).p + Vector3(0.001, 0, 0);
  std::vector<ModuleStart> starts;
  for (std::uint32_t i = 0; i < 16; ++i) {
    const Vector3 p = Vector3(0, 0, 0.4) + i * pitch;
    starts.push_back({.id = i + 1, .p_WB_m = {p.x(), p.y(), p.z()}, .hovering = true});
  }
  World world(WorldConfig{}, robot::legion(), starts);
  for (const ModuleStart& start : starts) world.actuate(start.id, hover_frame(LatchCommand::engage));
  world.advance(world.now() + 300ms);
  EXPECT_EQ(world.latched_links(), 15);
  for (const ModuleStart& start : starts) world.cut(start.id);
  world.advance(world.now() + 1500ms);
  EXPECT_EQ(world.latched_links(), 15);
  EXPECT_NEAR(world.truth_pose(8).X_WB.p.z(), 0.13, 0.01);
  EXPECT_LT(world.truth_pose(8).v_WB_m_s.norm(), 1e-2);
  EXPECT_FALSE(world.fault());
}

}  // namespace
}  // namespace eciton::hal::sim
