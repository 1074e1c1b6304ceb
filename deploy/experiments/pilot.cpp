// The operator's loop in virtual time.
#include "deploy/experiments/pilot.hpp"

#include <algorithm>
#include <stdexcept>

namespace eciton::deploy {
namespace {

constexpr Duration poll_period = std::chrono::milliseconds(20);

}  // namespace

Pilot::Pilot(Simulation& simulation)
    : simulation_(simulation), operator_(simulation.operators(), {.first_correlation_id = 1}) {}

void Pilot::wait(double duration_s) {
  wait_until([] { return false; }, duration_s);
}

bool Pilot::wait_until(const std::function<bool()>& done, double limit_s) {
  const TimePoint limit = simulation_.now() + from_s(limit_s);
  while (true) {
    operator_.poll(simulation_.now());
    if (done()) return true;
    if (simulation_.now() >= limit) return false;
    simulation_.executor().run_until(std::min(simulation_.now() + poll_period, limit));
    if (const auto& fault = simulation_.world().fault()) throw std::runtime_error(fault->message);
  }
}

GoalProgress Pilot::follow(std::uint64_t goal, double limit_s) {
  wait_until([&] { return is_over(operator_.report(goal)->progress); }, limit_s);
  return operator_.report(goal)->progress;
}

void Pilot::expect_success(const std::vector<std::uint64_t>& goals, double limit_s) {
  wait_until(
      [&] {
        return std::all_of(goals.begin(), goals.end(),
                           [&](std::uint64_t goal) { return is_over(operator_.report(goal)->progress); });
      },
      limit_s);
  for (const std::uint64_t goal : goals) {
    const GoalReport& report = *operator_.report(goal);
    if (report.progress == GoalProgress::succeeded) continue;
    throw std::runtime_error(report.what + ": " + std::string(to_string(report.progress)) + " " + report.reason);
  }
}

void Pilot::bring_to_hover(const std::vector<double>& heights_m) {
  wait(1.0);  // estimators start on the ground
  std::vector<std::uint64_t> goals;
  for (std::size_t k = 0; k < simulation_.size(); ++k) goals.push_back(operator_.arm(simulation_.id(k)));
  expect_success(goals, 10);
  goals.clear();
  for (std::size_t k = 0; k < simulation_.size(); ++k) {
    goals.push_back(operator_.take_off(simulation_.id(k), heights_m[k]));
  }
  expect_success(goals, 30);
  const auto all_zeroed = [&] {
    for (std::size_t k = 0; k < simulation_.size(); ++k) {
      const KnownModule* module = fleet().find(simulation_.id(k));
      if (module == nullptr || !module->beacon || !module->beacon->wrench_zeroed) return false;
    }
    return true;
  };
  wait_until(all_zeroed, 40);  // in strong gusts a measurement may have to begin again; docking says if it failed
}

GoalReport Pilot::dock(std::uint32_t follower, std::uint32_t target, double limit_s) {
  const std::uint64_t goal = operator_.dock(follower, target);
  follow(goal, limit_s);
  return *operator_.report(goal);
}

Still Pilot::still(const std::string& title) {
  return {.title = title, .time_s = simulation_.elapsed_s(), .posture = simulation_.world().posture()};
}

}  // namespace eciton::deploy
