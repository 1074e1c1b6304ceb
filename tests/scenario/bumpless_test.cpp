// Joining a chain and leaving it moves nothing: the wrench asked of the rotors has no step where the view changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "core/robot/allocation.hpp"
#include "tests/scenario/fleet.hpp"

namespace eciton::deploy {
namespace {

/// Watches one module's ring, command by command.
class Watch {
 public:
  Watch(Simulation& simulation, std::size_t module)
      : airframe_(robot::legion()),
        commands_(simulation.listener(module).create_reader(topics::rotor_command)),
        views_(simulation.listener(module).create_reader(topics::chain_view)),
        id_(simulation.id(module)) {}

  void look() {
    while (const auto view = views_.take()) {
      if (view->value.module_id != id_ || !view->value.active || view->value.active_epoch == epoch_) continue;
      epoch_ = view->value.active_epoch;
      since_change_ = 0;
    }
    while (const auto command = commands_.take()) {
      if (command->value.module_id != id_ || !command->value.armed) continue;
      std::array<robot::RotorOutput, 3> rotors;
      for (std::size_t k = 0; k < rotors.size(); ++k) {
        const msg::Rotor& r = command->value.rotors[k];
        rotors[k] = {r.thrust_N, {r.gimbal_rad[0], r.gimbal_rad[1]}};
      }
      const robot::Wrench now = robot::rotor_wrench_B(airframe_, rotors, robot::Vector3::Zero());
      const robot::Wrench step = now - last_;
      // The view is read in the step after it was written; ten commands hold the change.
      if (known_ && since_change_ < 10) {
        force_N = std::max(force_N, step.force.norm());
        moment_Nm = std::max(moment_Nm, step.moment.norm());
        ++seen;
      }
      ++since_change_;
      last_ = now;
      known_ = true;
    }
  }

  double force_N = 0, moment_Nm = 0;
  int seen = 0;

 private:
  robot::Airframe airframe_;
  bus::Reader<msg::RotorCommand> commands_;
  bus::Reader<msg::ChainView> views_;
  std::uint32_t id_;
  std::uint64_t epoch_ = 0;
  int since_change_ = 1000;
  robot::Wrench last_;
  bool known_ = false;
};

TEST(BumplessTest, JoiningAndLeavingStepsTheWrenchByLessThanANewton) {
  SimulationConfig config = row_of(2, 21);
  config.world.gust_N = 1;  // so that there is a feed-forward to hand over
  Simulation simulation(config);
  Pilot pilot(simulation);
  pilot.bring_to_hover(heights(2));
  Watch one(simulation, 0), two(simulation, 1);
  const auto look_on = [&](double limit_s, const std::function<bool()>& done) {
    const double until_s = simulation.elapsed_s() + limit_s;
    while (simulation.elapsed_s() < until_s && !done()) {
      simulation.executor().run_until(simulation.now() + std::chrono::milliseconds(1));
      pilot.op().poll(simulation.now());
      one.look();
      two.look();
    }
  };
  const auto fly = [&](std::uint64_t goal, double limit_s) {
    look_on(limit_s, [&] { return is_over(pilot.op().report(goal)->progress); });
    look_on(2, [] { return false; });  // until both have changed over
    return pilot.op().report(goal)->progress;
  };
  const auto expect_calm = [&](const char* when) {
    for (Watch* watch : {&one, &two}) {
      EXPECT_GE(watch->seen, 10) << when << ": nothing was seen";
      EXPECT_LT(watch->force_N, 1.0) << when;
      EXPECT_LT(watch->moment_Nm, 0.1) << when;
      watch->force_N = watch->moment_Nm = watch->seen = 0;
    }
  };
  ASSERT_EQ(fly(pilot.op().dock(2, 1), 40), GoalProgress::succeeded);
  expect_calm("joining");
  ASSERT_EQ(fly(pilot.op().undock(2, 1), 20), GoalProgress::succeeded);
  expect_calm("leaving");
}

}  // namespace
}  // namespace eciton::deploy
