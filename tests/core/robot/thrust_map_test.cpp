// The thrust map against values worked out by hand from the table, both ways, and over its whole range.
#include "core/robot/thrust_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace eciton::robot {
namespace {

const ThrustMap map = thrust_map(legion());

TEST(ThrustMapTest, GivesWhatTheTableSaysAtItsOwnVoltages) {
  // 80 %: p0 + 8 p1 + 640 p2.
  EXPECT_NEAR(map.thrust_N(80, 25.2), -6.361408 - 13.552224 + 31.72544, 1e-9);  // 11.811808
  EXPECT_NEAR(map.thrust_N(80, 24.2), -2.506118 - 20.585296 + 34.15616, 1e-9);  // 11.064746
  EXPECT_NEAR(map.thrust_N(80, 23.2), -3.402775 - 17.52636 + 31.29536, 1e-9);   // 10.366225
  EXPECT_NEAR(map.thrust_N(80, 22.2), -6.471275 - 8.397536 + 24.43584, 1e-9);   // 9.567029
  // The ends: 98 % at 25.2 V and at 22.2 V.
  EXPECT_NEAR(map.thrust_N(98, 25.2), 24.645106, 1e-6);
  EXPECT_NEAR(map.thrust_N(98, 22.2), 19.910776, 1e-6);
}

TEST(ThrustMapTest, BetweenItTakesTheNearestVoltageAndScalesByTheSquare) {
  EXPECT_NEAR(map.thrust_N(80, 24.6), 11.064746 * (24.6 * 24.6) / (24.2 * 24.2), 1e-6);
  EXPECT_NEAR(map.thrust_N(80, 24.8), 11.811808 * (24.8 * 24.8) / (25.2 * 25.2), 1e-6);
  EXPECT_NEAR(map.thrust_N(80, 21), 9.567029 * (21.0 * 21) / (22.2 * 22.2), 1e-6);
}

TEST(ThrustMapTest, HoverByHand) {
  // 12.8 N at 24.2 V: 0.0053369 x^2 - 0.2573162 x - 15.306118 = 0, so
  // x = (0.2573162 + sqrt(0.0662116 + 0.3267489)) / 0.0106738 = 82.837.
  EXPECT_NEAR(map.percent(12.8, 24.2), 82.837, 2e-3);
}

TEST(ThrustMapTest, BothWaysAgreeOverTheWholeRangeAtAnyVoltage) {
  for (double V = 20; V <= 26; V += 0.05) {
    for (double N = 2; N <= 19; N += 0.25) {
      const double x = map.percent(N, V);
      if (x < 98) {
        EXPECT_NEAR(map.thrust_N(x, V), N, 1e-9) << N << " at " << V;
      }
    }
  }
}

TEST(ThrustMapTest, RisesWithTheThrottleAtAnyVoltage) {
  for (const double V : {20.0, 22.2, 22.8, 23.6, 24.69, 24.71, 25.9}) {
    double before = -1;
    for (double x = 50; x <= 98; x += 0.1) {
      const double N = map.thrust_N(x, V);
      EXPECT_GT(N, before) << x << " at " << V;
      before = N;
    }
    EXPECT_EQ(map.thrust_N(99, V), map.thrust_N(98, V));
  }
}

TEST(ThrustMapTest, IsNotExtrapolated) {
  EXPECT_EQ(map.percent(0, 24.2), 50);
  EXPECT_EQ(map.percent(-3, 24.2), 50);
  EXPECT_EQ(map.percent(std::numeric_limits<double>::quiet_NaN(), 24.2), 50);
  EXPECT_EQ(map.percent(0.5, 24.2), map.percent(2, 24.2)) << "less than the least there is";
  EXPECT_EQ(map.percent(40, 24.2), 98) << "more than there is";
  EXPECT_EQ(map.percent(10, 0), 50) << "no battery";
  EXPECT_EQ(map.thrust_N(50, 24.2), 0);
  EXPECT_EQ(map.thrust_N(std::numeric_limits<double>::quiet_NaN(), 24.2), 0);
  const double lowest = map.percent(2, 24.2);
  EXPECT_NEAR(map.thrust_N(0.5 * (50 + lowest), 24.2), 1, 1e-9) << "half way to the least thrust, half of it";
}

TEST(ThrustMapTest, DshotByHand) {
  EXPECT_EQ(dshot_value(50), 0);
  EXPECT_EQ(dshot_value(40), 0);
  EXPECT_EQ(dshot_value(75), 1048);  // 0.5 * 1999 + 48 = 1047.5
  EXPECT_EQ(dshot_value(98), 1967);  // 0.96 * 1999 + 48 = 1967.04
  EXPECT_EQ(dshot_value(100), 2047);
  EXPECT_EQ(dshot_value(110), 2047);
}

TEST(ThrustMapTest, WithoutCurvesThrustIsInProportion) {
  Airframe other;
  other.name = "another";
  other.rotors.resize(1);
  other.rotors[0].thrust_N_max = 8;
  const ThrustMap plain = thrust_map(other);
  EXPECT_NEAR(plain.thrust_N(75, 11.1), 4, 1e-12);
  EXPECT_NEAR(plain.percent(4, 11.1), 75, 1e-12);
}

TEST(ThrustMapTest, WithoutCompensationAFallingBatteryCostsATenthOfTheThrust) {
  const double x = map.percent(12.8, 25);
  EXPECT_LT(map.thrust_N(x, 22.6), 0.92 * 12.8);
}

TEST(ThrustMapTest, TheAirframeAsksForNoLessThanTheMapGives) {
  for (const RotorGeometry& rotor : legion().rotors) EXPECT_EQ(rotor.thrust_N_min, map.thrust_N_min);
}

}  // namespace
}  // namespace eciton::robot
