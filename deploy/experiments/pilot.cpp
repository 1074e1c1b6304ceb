// The operator's loop in virtual time.
#include "deploy/experiments/pilot.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/robot/arrays.hpp"

namespace eciton::deploy {
namespace {

constexpr Duration poll_period = std::chrono::milliseconds(20);
constexpr double dock_limit_s = 60;
constexpr double agree_limit_s = 10;

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

void Pilot::zero_leaning() {
  constexpr double lean_rad = 0.2, way_m = 0.1, speed_m_s = 0.06;
  std::vector<std::uint64_t> goals;
  for (std::size_t k = 0; k < simulation_.size(); ++k) {
    const std::uint32_t id = simulation_.id(k);
    const msg::ModuleState& state = *fleet().find(id)->state;
    const robot::Vector3 p_W = robot::vector(state.p_WM_m);
    const auto at = [&](const robot::Vector3& way, const robot::Vector3& lean) {
      return msg::Waypoint{.p_WM_m = robot::array(p_W + way), .q_WM = robot::quaternion(robot::exp_so3(lean))};
    };
    const msg::Waypoint level = at(robot::Vector3::Zero(), robot::Vector3::Zero());
    goals.push_back(operator_.fly_path(
        id, std::array{at({way_m, 0, 0}, {0, lean_rad, 0}), level, at({0, way_m, 0}, {lean_rad, 0, 0}), level},
        speed_m_s));
    goals.push_back(operator_.zero(id));
  }
  expect_success(goals, 40);
}

GoalReport Pilot::dock(std::uint32_t follower, std::uint32_t target, double limit_s) {
  const double limit_at_s = simulation_.elapsed_s() + limit_s;
  while (true) {
    const std::uint64_t goal = operator_.dock(follower, target);
    follow(goal, limit_at_s - simulation_.elapsed_s());
    const GoalReport& report = *operator_.report(goal);
    // A disturbance may have made an observer measure its bias anew; that takes a while in free hover. And the last
    // docking may not have come to its end on both sides.
    const bool again =
        report.progress == GoalProgress::refused && (report.reason.find("zero") != std::string::npos ||
                                                     report.reason.find("docking already") != std::string::npos);
    if (!again || simulation_.elapsed_s() >= limit_at_s) return report;
    wait(0.5);
  }
}

std::vector<std::uint32_t> Pilot::members(std::uint32_t id) const {
  const KnownModule* module = fleet().find(id);
  if (module == nullptr || !module->in_chain()) return {id};
  return {module->view->members.begin(), module->view->members.end()};
}

std::uint32_t Pilot::base(std::uint32_t id) const {
  const std::vector<std::uint32_t> chain = members(id);
  return chain[(chain.size() + 1) / 2 - 1];
}

bool Pilot::agreed(std::size_t count) const {
  const KnownModule* first = fleet().find(simulation_.id(0));
  for (std::size_t k = 0; k < count; ++k) {
    const KnownModule* module = fleet().find(simulation_.id(k));
    if (module == nullptr || !module->view || !module->view->active || !module->settled()) return false;
    if (module->view->active_epoch != first->view->active_epoch || module->view->members.size() != count)
      return false;
  }
  return true;
}

void Pilot::assemble() {
  for (std::size_t k = 1; k < simulation_.size(); ++k) {
    const std::uint32_t follower = simulation_.id(k);
    const auto far = [&](std::uint32_t id) {
      return (simulation_.world().truth_pose(id).p_WM_m - simulation_.world().truth_pose(follower).p_WM_m).norm();
    };
    const std::vector<std::uint32_t> chain = members(simulation_.id(0));
    const std::uint32_t target = far(chain.front()) < far(chain.back()) ? chain.front() : chain.back();
    const GoalReport report = dock(follower, target, dock_limit_s);
    if (report.progress != GoalProgress::succeeded) {
      throw std::runtime_error(report.what + ": " + std::string(to_string(report.progress)) + " " + report.reason);
    }
    docking_s_max_ = std::max(docking_s_max_, to_s(report.ended_at - report.accepted_at));
    if (!wait_until([&] { return agreed(k + 1); }, agree_limit_s)) {
      throw std::runtime_error(report.what + ": the members did not agree on one chain");
    }
  }
}

void Pilot::separate() {
  const std::uint32_t first = simulation_.id(0);
  while (members(first).size() > 1) {
    const std::vector<std::uint32_t> chain = members(first);
    const bool at_back = chain.back() != first;
    expect(operator_.undock(at_back ? chain.back() : chain[0], at_back ? chain[chain.size() - 2] : chain[1]),
           dock_limit_s);
    if (!wait_until([&] { return members(first).size() < chain.size(); }, agree_limit_s)) {
      throw std::runtime_error("after an undocking the chain did not change");
    }
  }
}

Still Pilot::still(const std::string& title) {
  return {.title = title, .time_s = simulation_.elapsed_s(), .posture = simulation_.world().posture()};
}

}  // namespace eciton::deploy
