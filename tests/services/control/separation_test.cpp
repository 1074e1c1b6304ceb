// Modules that keep their distance, as points that follow their references with the errors of flight: nothing here
// knows how the filter works, only where the modules are.
#include "services/control/separation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace eciton::control {
namespace {

using robot::PoseReference;
using robot::Vector3;

constexpr double dt_s = 0.002;
constexpr double height_m = 1.5;
const Fence fence;

class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  /// Three standard normal numbers, by the sum of twelve.
  Vector3 normal() { return {normal1(), normal1(), normal1()}; }

 private:
  double unit() { return static_cast<double>(generator_() >> 11) * 0x1.0p-53; }
  double normal1() {
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += unit();
    return sum;
  }
  std::mt19937_64 generator_;
};

/// What was heard of a module: 50 Hz, 10 +- 3 ms late, one in twenty lost, with noise.
struct Heard {
  double at_s = 0, stamp_s = 0;
  Vector3 p, v;
};

struct Flyer {
  robot::PoseMotion way;
  Vector3 goal;
  Separation separation;
  Vector3 p, v = Vector3::Zero(), pushed = Vector3::Zero();
  std::vector<std::deque<Heard>> in_the_air;
  std::vector<Heard> known;
  bool arrived = false;
};

struct Meeting {
  std::vector<Vector3> starts, goals;
  std::uint64_t seed = 1;
  bool filtered = true;
  double gust_m_s2 = 0.2;  // 0.8 N on a module
  double limit_s = 60;
  double mute_from_s = 1e9, mute_to_s = 1e9;  // nobody hears anything
};

struct Outcome {
  double distance_m_min = 1e9;
  std::size_t arrived = 0;
  double time_s = 0;
};

void talk(std::vector<Flyer>& flyers, double t, Random& random) {
  for (std::size_t from = 0; from < flyers.size(); ++from) {
    for (std::size_t to = 0; to < flyers.size(); ++to) {
      if (from == to || random.uniform(0, 1) < 0.05) continue;
      flyers[to].in_the_air[from].push_back({t + 0.010 + random.uniform(-0.003, 0.003), t,
                                             flyers[from].p + 0.003 * random.normal(),
                                             flyers[from].v + 0.02 * random.normal()});
    }
  }
}

void fly(Flyer& me, double t, bool filtered, double gust_m_s2, Random& random) {
  std::vector<Neighbour> others;
  for (std::size_t k = 0; k < me.known.size(); ++k) {
    while (!me.in_the_air[k].empty() && me.in_the_air[k].front().at_s <= t) {
      me.known[k] = me.in_the_air[k].front();
      me.in_the_air[k].pop_front();
    }
    const Heard& heard = me.known[k];
    if (heard.at_s > 0) others.push_back({.p_WM = heard.p, .v_WM = heard.v, .age_s = t - heard.stamp_s});
  }
  PoseReference reference = me.way.at(t);
  if (filtered) {
    const Vector3 ahead = me.way.at(t + me.separation.config().look_ahead_s).p_WM;
    reference = me.separation.update(
        {.nominal = reference, .p_WM_ahead = ahead, .p_WM = me.p, .neighbours = others, .fence = fence}, dt_s);
  }
  me.pushed += -me.pushed * dt_s + gust_m_s2 * std::sqrt(2 * dt_s) * random.normal();
  const Vector3 a = reference.a_WM + 8 * (reference.v_WM - me.v) + 20 * (reference.p_WM - me.p) + me.pushed;
  me.v += a * dt_s;
  me.p += me.v * dt_s;
  me.arrived = me.arrived || (me.way.finished(t) && !me.separation.gives_way() && (me.p - me.goal).norm() < 0.15);
}

Outcome run(const Meeting& meeting) {
  Random random(meeting.seed);
  const std::size_t n = meeting.starts.size();
  std::vector<Flyer> flyers(n);
  for (std::size_t k = 0; k < n; ++k) {
    PoseReference from;
    from.p_WM = flyers[k].p = meeting.starts[k];
    flyers[k].goal = meeting.goals[k];
    flyers[k].way =
        robot::PoseMotion(from, {meeting.goals[k], robot::Matrix3::Identity()}, 1 + random.uniform(0, 0.05),
                          robot::SpeedProfile::trapezoid, {.speed_m_s = random.uniform(0.5, 0.8)});
    flyers[k].in_the_air.resize(n);
    flyers[k].known.resize(n);
  }
  Outcome out;
  for (int step = 0; out.time_s < meeting.limit_s && out.arrived < n; ++step) {
    const double t = out.time_s = (step + 1) * dt_s;
    if (step % 10 == 0 && !(t > meeting.mute_from_s && t < meeting.mute_to_s)) talk(flyers, t, random);
    out.arrived = 0;
    for (std::size_t k = 0; k < n; ++k) {
      fly(flyers[k], t, meeting.filtered, meeting.gust_m_s2, random);
      out.arrived += flyers[k].arrived ? 1 : 0;
      for (std::size_t i = 0; i < k; ++i) {
        out.distance_m_min = std::min(out.distance_m_min, (flyers[k].p - flyers[i].p).norm());
      }
    }
  }
  return out;
}

Meeting corners(double side_m) {
  Meeting m;
  for (const auto& [x, y] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
    m.starts.emplace_back(x * side_m / 2, y * side_m / 2, height_m);
    m.goals.emplace_back(-x * side_m / 2, -y * side_m / 2, height_m);
  }
  return m;
}

std::vector<Vector3> places(std::size_t n, Random& random) {
  std::vector<Vector3> out;
  while (out.size() < n) {
    const Vector3 p(random.uniform(-2.7, 2.7), random.uniform(-2.7, 2.7), height_m + random.uniform(-0.2, 0.2));
    if (std::all_of(out.begin(), out.end(), [&](const Vector3& q) { return (p - q).head<2>().norm() > 1.5; })) {
      out.push_back(p);
    }
  }
  return out;
}

TEST(SeparationTest, FourExchangePlacesThroughOnePoint) {
  for (const double side_m : {3.0, 4.0}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      Meeting m = corners(side_m);
      m.seed = seed;
      const Outcome o = run(m);
      EXPECT_GT(o.distance_m_min, 1.1) << "side " << side_m << ", seed " << seed;
      EXPECT_EQ(o.arrived, 4u) << "side " << side_m << ", seed " << seed;
      EXPECT_LT(o.time_s, 30);
    }
  }
}

TEST(SeparationTest, WithoutItTheyMeetInTheMiddle) {
  Meeting m = corners(3);
  m.filtered = false;
  EXPECT_LT(run(m).distance_m_min, 0.5);
}

TEST(SeparationTest, AnyStartsAndGoalsAreFlownApartAndAllArrive) {
  for (std::size_t n = 4; n <= 6; ++n) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Random random(1000 * n + seed);
      Meeting m;
      m.starts = places(n, random);
      m.goals = places(n, random);
      m.seed = seed;
      const Outcome o = run(m);
      EXPECT_GT(o.distance_m_min, 1.1) << n << " modules, seed " << seed;
      EXPECT_EQ(o.arrived, n) << n << " modules, seed " << seed;
    }
  }
}

TEST(SeparationTest, SilenceInTheMiddleOfAMeetingIsSurvived) {
  // Whoever is not heard is expected to go on as it went, and is kept further off than before.
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Meeting m = corners(4);
    m.seed = seed;
    m.mute_from_s = 2.5;
    m.mute_to_s = 5;
    const Outcome o = run(m);
    EXPECT_GT(o.distance_m_min, 1.0) << "seed " << seed;
    EXPECT_EQ(o.arrived, 4u) << "seed " << seed;
  }
}

PoseReference at_rest(const Vector3& p) {
  PoseReference r;
  r.p_WM = p;
  return r;
}

/// Flies the filter alone, at a nominal reference, beside one neighbour; the last reference.
PoseReference fly_beside(Separation& filter, const std::function<PoseReference(double)>& nominal,
                         const std::function<Neighbour(double)>& neighbour, double duration_s,
                         const std::function<void(double, const PoseReference&)>& watch = {}) {
  PoseReference out;
  for (double t = 0; t < duration_s; t += dt_s) {
    const Neighbour other = neighbour(t);
    out = filter.update({.nominal = nominal(t),
                         .p_WM_ahead = nominal(t + filter.config().look_ahead_s).p_WM,
                         .p_WM = out.p_WM,
                         .neighbours = std::span(&other, 1),
                         .fence = fence},
                        dt_s);
    if (watch) watch(t, out);
  }
  return out;
}

robot::PoseMotion straight(const Vector3& from, const Vector3& to, double speed_m_s) {
  return {
      at_rest(from), {to, robot::Matrix3::Identity()}, 0.5, robot::SpeedProfile::trapezoid, {.speed_m_s = speed_m_s}};
}

TEST(SeparationTest, WithNothingInTheWayTheReferenceIsTheNominalOneToTheBit) {
  Separation filter;
  const robot::PoseMotion way = straight({-2, 0, 1}, {2, 1, 1.5}, 0.8);
  // Behind, and standing beside the way.
  for (const Vector3& other : {Vector3(-3.6, 0, 1), Vector3(0, -1.8, 1)}) {
    fly_beside(
        filter, [&](double t) { return way.at(t); }, [&](double) { return Neighbour{.p_WM = other}; }, 9,
        [&](double t, const PoseReference& r) {
          ASSERT_EQ(r.p_WM, way.at(t).p_WM);
          ASSERT_EQ(r.v_WM, way.at(t).v_WM);
          ASSERT_EQ(r.a_WM, way.at(t).a_WM);
        });
  }
}

TEST(SeparationTest, TheReferenceHasNoJumpsAndKeepsItsAcceleration) {
  Separation filter;
  const robot::PoseMotion way = straight({-2, 0, 1}, {2, 0, 1}, 0.8);
  PoseReference before = way.at(0);
  double jump_m = 0, jump_m_s = 0, a_max = 0;
  bool gave_way = false;
  const PoseReference end = fly_beside(
      filter, [&](double t) { return way.at(t); },
      [](double) {
        return Neighbour{.p_WM = {0, 0, 1}};
      },
      25,
      [&](double, const PoseReference& r) {
        jump_m = std::max(jump_m, (r.p_WM - before.p_WM - before.v_WM * dt_s).norm());
        jump_m_s = std::max(jump_m_s, (r.v_WM - before.v_WM).norm());
        a_max = std::max(a_max, r.a_WM.norm());
        EXPECT_GT((r.p_WM - Vector3(0, 0, 1)).norm(), 1.2);
        gave_way = gave_way || filter.gives_way();
        before = r;
      });
  EXPECT_TRUE(gave_way);
  EXPECT_LT(jump_m, 1.1e-3);    // when it takes up the nominal reference again
  EXPECT_LT(jump_m_s, 1.0e-2);  // 2 m/s^2 for 2 ms, and the like
  EXPECT_LE(a_max, 2 + 1e-9);
  EXPECT_FALSE(filter.gives_way());
  EXPECT_EQ(end.p_WM, way.at(100).p_WM);
}

TEST(SeparationTest, TheOtherIsPassedOnTheLeft) {
  Separation filter;
  const robot::PoseMotion way = straight({-2, 0, 1}, {2, 0, 1}, 0.8);
  double y_min = 0, y_max = 0;
  fly_beside(
      filter, [&](double t) { return way.at(t); },
      [](double) {
        return Neighbour{.p_WM = {0, 0, 1}};
      },
      15,
      [&](double, const PoseReference& r) {
        y_min = std::min(y_min, r.p_WM.y());
        y_max = std::max(y_max, r.p_WM.y());
      });
  EXPECT_LT(y_min, -1.2);
  EXPECT_LT(y_max, 0.1);
}

TEST(SeparationTest, HoveringItGivesWayToAnIntruderAndComesBack) {
  Separation filter;
  const PoseReference place = at_rest({0, 0, 1});
  double least_m = 1e9;
  const PoseReference end = fly_beside(
      filter, [&](double) { return place; },
      [](double t) {
        return Neighbour{.p_WM = {-4 + 0.5 * t, 0.1, 1}, .v_WM = {0.5, 0, 0}, .gives_way = false};
      },
      30,
      [&](double t, const PoseReference& r) {
        least_m = std::min(least_m, (r.p_WM - Vector3(-4 + 0.5 * t, 0.1, 1)).norm());
      });
  EXPECT_GT(least_m, 1.15);
  EXPECT_EQ(end.p_WM, place.p_WM);
}

TEST(SeparationTest, ItNeverFliesUnderWhoHovers) {
  Separation filter;
  const robot::PoseMotion way = straight({-3, 0, 0.8}, {3, 0, 0.8}, 0.8);
  fly_beside(
      filter, [&](double t) { return way.at(t); },
      [](double) {
        return Neighbour{.p_WM = {0, 0, 2}};
      },
      15, [](double, const PoseReference& r) { EXPECT_GT(r.p_WM.head<2>().norm(), 1.2); });
}

TEST(SeparationTest, FarBelowItPassesButDoesNotRise) {
  Separation filter;
  const robot::PoseMotion under = straight({-2, 0, 1}, {0, 0, 1}, 0.8);
  const auto above = [](double) { return Neighbour{.p_WM = {0, 0, 4}}; };
  EXPECT_EQ(fly_beside(
                filter, [&](double t) { return under.at(t); }, above, 8)
                .p_WM,
            Vector3(0, 0, 1));
  const robot::PoseMotion up = straight({0, 0, 1}, {0, 0, 3.5}, 0.5);
  const PoseReference end = fly_beside(
      filter, [&](double t) { return up.at(t); }, above, 10);
  EXPECT_NEAR(end.p_WM.z(), 2.5, 0.05);
}

TEST(SeparationTest, TheFenceHolds) {
  // Pushed by somebody who does not give way, towards the fence and not through it.
  Separation filter;
  const Fence narrow{{-50, -50, 0}, {0.5, 50, 30}};
  PoseReference r = at_rest({0, 0, 1});
  for (double t = 0; t < 20; t += dt_s) {
    const Neighbour other{.p_WM = {-4 + 0.3 * t, 0, 1}, .v_WM = {0.3, 0, 0}, .gives_way = false};
    r = filter.update({.nominal = at_rest({0, 0, 1}),
                       .p_WM_ahead = {0, 0, 1},
                       .p_WM = r.p_WM,
                       .neighbours = std::span(&other, 1),
                       .fence = narrow},
                      dt_s);
    ASSERT_LT(r.p_WM.x(), 0.55);
  }
  // A reference that leads out of it is not followed.
  Separation tracking;
  for (double t = 0; t < 20; t += dt_s) {
    PoseReference leaving = at_rest({-2 + 0.5 * t, 0, 1});
    leaving.v_WM = {0.5, 0, 0};
    r = tracking.update({.nominal = leaving,
                         .p_WM_ahead = leaving.p_WM + Vector3(1, 0, 0),
                         .p_WM = leaving.p_WM,
                         .neighbours = {},
                         .fence = narrow},
                        dt_s);
    ASSERT_LT(r.p_WM.x(), 0.51);
  }
  EXPECT_NEAR(r.p_WM.x(), 0.5, 0.02);
}

TEST(SeparationTest, ASilentNeighbourIsKeptFurtherOffButNotFledFrom) {
  Separation filter;
  const PoseReference beside = at_rest({1.4, 0, 1});
  const auto silent = [](double t) { return Neighbour{.p_WM = {0, 0, 1}, .age_s = t}; };
  EXPECT_EQ(fly_beside(
                filter, [&](double) { return beside; }, silent, 5)
                .p_WM,
            beside.p_WM);
  const robot::PoseMotion way = straight({3.2, 0, 1}, {1.4, 0, 1}, 0.8);
  const PoseReference near = fly_beside(
      filter, [&](double t) { return way.at(t); },
      [](double t) {
        return Neighbour{.p_WM = {0, 0, 1}, .age_s = 10 + t};
      },
      20);
  EXPECT_GT(near.p_WM.head<2>().norm(), 2.0);
}

TEST(SeparationTest, WhatItKeepsIsEnoughToGoOnWith) {
  // A second filter that starts from the first one's state goes on to the bit.
  Separation filter;
  const robot::PoseMotion way = straight({-2, 0, 1}, {2, 0, 1}, 0.8);
  const auto nominal = [&](double t) { return way.at(t); };
  const auto other = [](double) { return Neighbour{.p_WM = {0, 0, 1}}; };
  fly_beside(filter, nominal, other, 3);
  ASSERT_TRUE(filter.gives_way());
  Separation again = filter;
  const auto later = [&](double t) { return way.at(t + 3); };
  EXPECT_EQ(fly_beside(filter, later, other, 1).p_WM, fly_beside(again, later, other, 1).p_WM);
}

TEST(StoppingSpeedTest, BrakesInTimeAndIsSmoothAtTheEnd) {
  // From there with 2 m/s^2 to rest: v^2 / 2a never more than the way.
  for (double d = 0.01; d < 3; d += 0.01) {
    const double v = stopping_speed_m_s(d, 2, 0.4);
    EXPECT_LE(v * v / 4, d);
    EXPECT_GT(v, 0);
  }
  EXPECT_NEAR(stopping_speed_m_s(1e-6, 2, 0.4), 1e-6 / 0.4, 1e-10);
  EXPECT_DOUBLE_EQ(stopping_speed_m_s(-0.2, 2, 0.4), -0.5);
}

}  // namespace
}  // namespace eciton::control
