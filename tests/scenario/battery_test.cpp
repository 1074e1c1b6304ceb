// A battery that runs down in flight: thrust stays what is asked for, because the throttle follows the voltage.
#include <gtest/gtest.h>

#include "core/robot/arrays.hpp"
#include "tests/scenario/fleet.hpp"

namespace eciton::deploy {
namespace {

struct Flight {
  double battery_V_first = 0, battery_V_last = 0;
  double lift_N = 0;  // that the wrench observer misses, or finds too much, at the end
  double error_m = 0;
};

/// Hovers while a battery loses in 40 s what others lose in six minutes.
Flight hover_on_a_failing_battery(bool compensation) {
  SimulationConfig config = row_of(1, 8);
  config.world.battery.discharge_V_min = 3.5;
  config.module.hal.battery_compensation = compensation;
  Simulation simulation(config);
  Pilot pilot(simulation);
  auto rotors = simulation.listener(0).create_reader(topics::rotor_state);
  auto wrenches = simulation.listener(0).create_reader(topics::external_wrench);
  Flight out;
  pilot.wait(0.5);
  out.battery_V_first = rotors.take_newest()->value.battery_V;
  pilot.bring_to_hover({1.2});
  pilot.wait(30);
  int samples = 0;
  wrenches.take_newest();
  pilot.wait_until(
      [&] {
        if (const auto wrench = wrenches.take_newest()) out.lift_N += wrench->value.force_W_N[2], ++samples;
        return false;
      },
      2);
  out.lift_N /= samples;
  out.battery_V_last = rotors.take_newest()->value.battery_V;
  out.error_m = (simulation.world().truth_pose(1).p_WM_m - robot::Vector3(0, 0, 1.2)).norm();
  return out;
}

TEST(BatteryScenarioTest, CompensationKeepsThrustWhatItIsCalled) {
  const Flight flight = hover_on_a_failing_battery(true);
  EXPECT_NEAR(flight.battery_V_first, 25, 0.1);
  EXPECT_LT(flight.battery_V_last, 23) << "else nothing was tried";
  EXPECT_LT(std::abs(flight.lift_N), 1);
  EXPECT_LT(flight.error_m, 0.03);
}

TEST(BatteryScenarioTest, NegativeControlWithoutCompensationThrustIsATenthLessThanItIsCalled) {
  const Flight flight = hover_on_a_failing_battery(false);
  EXPECT_LT(flight.lift_N, -1.5) << "of 38 N; the zero was measured when a part was gone already";
}

}  // namespace
}  // namespace eciton::deploy
