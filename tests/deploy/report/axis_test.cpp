// Where values stand on an axis, and what is written beside it.
#include "deploy/report/axis.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace eciton::report {
namespace {

std::vector<double> values(const Axis& axis) {
  std::vector<double> out;
  for (const Tick& tick : axis.ticks()) out.push_back(tick.value);
  return out;
}

TEST(AxisTest, ASmallRangeIsLinearFromZero) {
  const Axis axis = Axis::around(20, 100);
  EXPECT_FALSE(axis.logarithmic());
  EXPECT_DOUBLE_EQ(axis.position(0), 0);
  EXPECT_DOUBLE_EQ(axis.position(52.5), 0.5);
  EXPECT_EQ(values(axis), (std::vector<double>{0, 20, 40, 60, 80, 100}));
}

TEST(AxisTest, ATailIsLogarithmic) {
  const Axis axis = Axis::around(11, 9000);
  EXPECT_TRUE(axis.logarithmic());
  EXPECT_NEAR(axis.position(std::sqrt(10 * 9900.)), 0.5, 1e-9);
  EXPECT_EQ(values(axis), (std::vector<double>{10, 20, 50, 100, 200, 500, 1000, 2000, 5000}));
}

TEST(AxisTest, NothingStandsOutside) {
  for (const Axis& axis : {Axis::around(1, 1000), Axis::around(0, 5), Axis::around(-2, 5), Axis::from_zero(0)}) {
    EXPECT_EQ(axis.position(1e9), 1);
    EXPECT_EQ(axis.position(-1e9), 0);
    for (const Tick& tick : axis.ticks()) {
      EXPECT_GE(axis.position(tick.value), 0);
      EXPECT_LE(axis.position(tick.value), 1);
    }
    EXPECT_GE(axis.ticks().size(), 2u);
    EXPECT_LE(axis.ticks().size(), 12u);
  }
}

TEST(AxisTest, LabelsAreShort) {
  std::string labels;
  for (const Tick& tick : Axis::from_zero(1.1).ticks()) labels += tick.label + " ";
  EXPECT_EQ(labels, "0 0.2 0.4 0.6 0.8 1 ");
  EXPECT_EQ(Axis::exactly(0, 6000).ticks().back().label, "6,000");
}

TEST(AxisTest, RoomIsLeftOnTheSideThatHasValues) {
  EXPECT_DOUBLE_EQ(Axis::with_room(2, 10).position(0), 0);  // from zero
  EXPECT_DOUBLE_EQ(Axis::with_room(2, 10).position(10), 10 / 10.5);
  EXPECT_DOUBLE_EQ(Axis::with_room(-10, -2).position(0), 1);
  const Axis both = Axis::with_room(-1, 1);
  EXPECT_GT(both.position(-1), 0);
  EXPECT_LT(both.position(1), 1);
  EXPECT_EQ(values(both), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
}

TEST(AxisTest, ALogarithmicAxisMayBeAskedFor) {
  const Axis axis = Axis::of_logarithms(1, 10);
  EXPECT_TRUE(axis.logarithmic());
  EXPECT_EQ(values(axis), (std::vector<double>{1, 2, 5, 10}));
}

}  // namespace
}  // namespace eciton::report
