// The steps that flights share.
#include <algorithm>
#include <cmath>

#include "core/base/wall_clock.hpp"
#include "deploy/command/fleet_flight.hpp"

namespace eciton::deploy {
namespace {

constexpr double height_m = 1.5;
constexpr double home_speed_m_s = 0.8;
constexpr double settle_s = 2.5;  // of a hover before it counts as one

// Time-outs, on the modules' clock.
constexpr double start_timeout_s = 20, arm_timeout_s = 10, flight_timeout_s = 30, zero_timeout_s = 20,
                 dock_timeout_s = 60;

double distance(const msg::ModuleState& a, const msg::ModuleState& b) {
  return std::hypot(a.p_WM_m[0] - b.p_WM_m[0], a.p_WM_m[1] - b.p_WM_m[1], a.p_WM_m[2] - b.p_WM_m[2]);
}

}  // namespace

std::string members_text(const msg::ChainView& view) {
  std::string text;
  for (const std::uint32_t member : view.members) text += (text.empty() ? "" : "-") + std::to_string(member);
  return text;
}

void FleetFlight::wait_for_modules() {
  begin("modules start and find each other", DemoPhase::grounded);
  const auto ready = [&](std::uint32_t id, const DemoEar& ear) {
    const KnownModule* module = operator_.fleet().find(id);
    return module != nullptr && module->state && module->state->mode == msg::EstimatorMode::ready &&
           ear.flight_mode().has_value();
  };
  const auto all_ready = [&] {
    return std::all_of(ears_.begin(), ears_.end(), [&](const auto& ear) { return ready(ear->id(), *ear); });
  };
  const auto lacks = [&] {
    std::string text;
    for (const auto& ear : ears_) {
      if (ready(ear->id(), *ear)) continue;
      text += (text.empty() ? "m" : ", m") + std::to_string(ear->id());
    }
    return text + " not ready (heard on the swarm ring: " + operator_.fleet().heard() + ")";
  };
  // Until the first state is heard there is no modules' clock to go by.
  const Duration wall_begin = monotonic_now();
  while (!operator_.fleet().time_known()) {
    pump();
    if (monotonic_now() - wall_begin > from_s(3 * start_timeout_s))
      fail("no module is heard", {fleet_.plans[0].name + "/world"});
  }
  time_begin_ = advanced_to_ = operator_.module_now();
  wait_until(all_ready, start_timeout_s, lacks);
}

void FleetFlight::arm_and_take_off() {
  begin("arm", DemoPhase::grounded);
  finish(for_each_module([&](std::uint32_t id, std::size_t) { return operator_.arm(id); }), arm_timeout_s);
  begin("take off", DemoPhase::other);
  finish(for_each_module([&](std::uint32_t id, std::size_t) { return operator_.take_off(id, height_m); }),
         flight_timeout_s);
}

void FleetFlight::hover_until_zeroed() {
  begin("hover, while the wrench observers are zeroed", DemoPhase::other);
  hover(settle_s);
  for (std::size_t k = 0; k < ears_.size(); ++k) ears_[k]->set_goal(home_m(k));
  phase_ = DemoPhase::hovering;
  const auto zeroed = [](const auto& ear) { return ear->zeroed(); };
  wait_until([&] { return std::all_of(ears_.begin(), ears_.end(), zeroed); }, zero_timeout_s,
             [&] {
               std::string text = "not zeroed:";
               for (const auto& ear : ears_) {
                 if (!ear->zeroed()) text += " m" + std::to_string(ear->id());
               }
               return text;
             });
  hover(1);
  for (const auto& ear : ears_) ear->set_goal(std::nullopt);
}

std::uint32_t FleetFlight::target_for(std::uint32_t follower) const {
  const msg::ChainView* view = view_of(ids_.front());
  if (view == nullptr || view->members.size() < 2) return ids_.front();
  const KnownFleet& fleet = operator_.fleet();
  const auto far = [&](std::uint32_t id) { return distance(*fleet.find(id)->state, *fleet.find(follower)->state); };
  const std::uint32_t front = view->members[0], back = view->members.back();
  return far(front) < far(back) ? front : back;
}

std::uint64_t FleetFlight::dock(std::uint32_t follower) {
  const std::uint32_t target = target_for(follower);
  begin("dock " + std::to_string(follower) + " " + std::to_string(target), DemoPhase::docking);
  const double begin_s = now_s();
  std::uint64_t goal = 0;
  while (true) {
    goal = operator_.dock(follower, target);
    follow({goal}, dock_timeout_s);
    const GoalReport& report = *operator_.report(goal);
    // Its bias may be measured anew after a disturbance; that takes a while in free hover.
    const bool again = report.progress == GoalProgress::refused && report.reason.find("zero") != std::string::npos &&
                       now_s() - begin_s < zero_timeout_s;
    if (!again) break;
    hover(0.5);
  }
  finish({goal}, dock_timeout_s);
  return goal;
}

void FleetFlight::agree(std::size_t members) {
  const auto agreed = [&] {
    for (std::size_t k = 0; k < members; ++k) {
      const msg::ChainView *view = view_of(ids_[k]), *first = view_of(ids_.front());
      if (view == nullptr || !view->active || view->active_epoch != first->active_epoch) return false;
      if (view->epoch != view->active_epoch || view->members.size() != members) return false;
    }
    return true;
  };
  wait_until(agreed, flight_timeout_s, [&] {
    std::string text = "the members' views differ:";
    for (std::size_t k = 0; k < members; ++k) {
      const msg::ChainView* view = view_of(ids_[k]);
      text += " m" + std::to_string(ids_[k]) + " has " + (view != nullptr ? members_text(*view) : "none");
    }
    return text;
  });
}

void FleetFlight::undock_all() {
  while (true) {
    const msg::ChainView* view = view_of(ids_.front());
    const std::size_t members = view == nullptr ? 0 : view->members.size();
    if (members < 2) break;
    // The end that is not the first module leaves.
    const bool at_back = view->members.back() != ids_.front();
    const std::uint32_t leaving = at_back ? view->members.back() : view->members[0];
    const std::uint32_t staying = at_back ? view->members[members - 2] : view->members[1];
    begin("undock " + std::to_string(leaving) + " " + std::to_string(staying), DemoPhase::other);
    finish({operator_.undock(leaving, staying)}, flight_timeout_s);
    const auto apart = [&] {
      const msg::ChainView *left = view_of(leaving), *rest = view_of(ids_.front());
      return left->members.size() < 2 && rest->members.size() < members && left->epoch == left->active_epoch &&
             rest->epoch == rest->active_epoch;
    };
    wait_until(apart, flight_timeout_s, [&] { return "the chain is still " + members_text(*view_of(ids_.front())); });
    hover(1);
  }
  const auto loose = [](const auto& ear) { return !ear->latched(); };
  wait_until([&] { return std::all_of(ears_.begin(), ears_.end(), loose); }, 5, [] { return "a latch still holds"; });
}

std::array<double, 3> FleetFlight::home_m(std::size_t k) const {
  return {fleet_.start_m[k][0], fleet_.start_m[k][1], height_m};
}

void FleetFlight::go_home() {
  finish(for_each_module(
             [&](std::uint32_t id, std::size_t k) { return operator_.go_to(id, home_m(k), 0, home_speed_m_s); }),
         flight_timeout_s);
}

void FleetFlight::spread_and_land() {
  begin("go back and hover", DemoPhase::other);
  go_home();
  hover(settle_s);
  for (std::size_t k = 0; k < ears_.size(); ++k) ears_[k]->set_goal(home_m(k));
  phase_ = DemoPhase::hovering;
  hover(1.5);
  for (const auto& ear : ears_) ear->set_goal(std::nullopt);
  begin("land", DemoPhase::other);
  finish(for_each_module([&](std::uint32_t id, std::size_t) { return operator_.land(id); }), flight_timeout_s);
  // A landing ends disarmed; one that did not is told to.
  Goals goals;
  for (const auto& ear : ears_) {
    if (ear->flight_mode() != msg::FlightMode::disarmed) goals.push_back(operator_.disarm(ear->id()));
  }
  if (goals.empty()) return;
  begin("disarm", DemoPhase::grounded);
  finish(goals, arm_timeout_s);
}

}  // namespace eciton::deploy
