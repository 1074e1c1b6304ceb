// More is asked of the rotors than they have: the attitude is kept, and the place found again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/robot/arrays.hpp"
#include "tests/scenario/fleet.hpp"

namespace eciton::deploy {
namespace {

/// Against upright with the heading it has.
double tilt_rad(Simulation& simulation) {
  const robot::Vector3 up = simulation.world().truth_pose(1).X_WB.R.col(2);
  return std::atan2(up.head<2>().norm(), up.z());
}

TEST(SaturationTest, AStepOfThreeMetresTiltsItLittleAndIsFlown) {
  Simulation simulation(row_of(1, 31));
  Pilot pilot(simulation);
  pilot.bring_to_hover({1.5});
  // As a docking service that has lost its mind would ask: at once three metres on.
  auto references = simulation.listener(0).create_writer(topics::docking_reference);
  double tilt_max = 0, height_min = 9;
  const double until_s = simulation.elapsed_s() + 8;
  while (simulation.elapsed_s() < until_s) {
    msg::DockingReference step;
    step.module_id = 1;
    step.stamp_ns = to_ns(simulation.now());
    step.p_WM_m = {3, 0, 1.5};
    step.q_WM = {1, 0, 0, 0};
    references.write(step);
    pilot.wait(0.02);
    tilt_max = std::max(tilt_max, tilt_rad(simulation));
    height_min = std::min(height_min, simulation.world().truth_pose(1).p_WM_m.z());
  }
  EXPECT_LT(tilt_max, 0.35);
  EXPECT_GT(height_min, 1.2);
  EXPECT_LT((simulation.world().truth_pose(1).p_WM_m - robot::Vector3(3, 0, 1.5)).norm(), 0.1);
}

TEST(SaturationTest, AGustOfTenNewtonsIsRiddenOut) {
  SimulationConfig config = row_of(1, 32);
  config.world.gust_N = 10;
  Simulation simulation(config);
  Pilot pilot(simulation);
  pilot.bring_to_hover({3});
  double tilt_max = 0, off_sum = 0;
  constexpr int samples = 500;
  for (int k = 0; k < samples; ++k) {
    pilot.wait(0.02);
    tilt_max = std::max(tilt_max, tilt_rad(simulation));
    off_sum += (simulation.world().truth_pose(1).p_WM_m - robot::Vector3(0, 0, 3)).norm();
  }
  EXPECT_LT(tilt_max, 0.35);
  EXPECT_LT(off_sum / samples, 0.5);
}

}  // namespace
}  // namespace eciton::deploy
