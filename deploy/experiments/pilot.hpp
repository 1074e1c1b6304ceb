// Flies a simulated fleet by the goals an operator would send: runs the simulation until what was asked for
// has happened, or its time is up.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "deploy/experiments/experiment.hpp"
#include "deploy/operator/operator.hpp"
#include "deploy/simulation.hpp"

namespace eciton::deploy {

class Pilot {
 public:
  explicit Pilot(Simulation& simulation);

  /// Runs on for so long.
  void wait(double duration_s);
  /// Runs until `done` holds, at most so long; whether it holds.
  bool wait_until(const std::function<bool()>& done, double limit_s);
  /// Runs until the goal is over, at most so long; how it ended.
  GoalProgress follow(std::uint64_t goal, double limit_s);

  /// Arms all modules, takes them off to their heights, and lets them hover until their observers are zeroed.
  /// Throws std::runtime_error naming the module and the step that failed.
  void bring_to_hover(const std::vector<double>& heights_m);
  /// Zeroes all modules, which hover level, anew, while each leans over slowly, forward and to a side: what is false
  /// in the height of the centre of mass and in the sensor's yaw shows only so. Throws likewise.
  void zero_leaning();
  /// Docks, asking again while it is refused for want of zeroing. The report of the last goal.
  GoalReport dock(std::uint32_t follower, std::uint32_t target, double limit_s);
  /// Docks all modules one by one, each to the nearer end of the chain so far, into one chain that has agreed. Throws
  /// std::runtime_error naming the docking that failed.
  void assemble();
  /// Undocks one by one, always the end that is not the first module. Throws likewise.
  void separate();
  /// Runs until the goal has succeeded; throws std::runtime_error naming it otherwise.
  void expect(std::uint64_t goal, double limit_s) { expect_success({goal}, limit_s); }

  /// The longest docking of `assemble`, from the accepted goal to its end.
  double docking_s_max() const { return docking_s_max_; }

  /// Members of the chain that a module flies in, in its order; itself when it flies alone.
  std::vector<std::uint32_t> members(std::uint32_t id) const;
  /// Of the chain; number (n + 1) / 2, counted from 1.
  std::uint32_t base(std::uint32_t id) const;

  /// The moment as it is, to be drawn after the run. Asking changes nothing.
  Still still(const std::string& title);

  Operator& op() { return operator_; }
  const KnownFleet& fleet() const { return operator_.fleet(); }

 private:
  bool agreed(std::size_t members) const;
  void expect_success(const std::vector<std::uint64_t>& goals, double limit_s);

  Simulation& simulation_;
  Operator operator_;
  double docking_s_max_ = 0;
};

}  // namespace eciton::deploy
