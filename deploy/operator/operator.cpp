// Goals out, answers in.
#include "deploy/operator/operator.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace eciton::deploy {
namespace {

/// Unlike that of any other operator, now or before: services ignore an id they have answered.
std::uint64_t drawn_correlation_id() {
  timespec t{};
  ::clock_gettime(CLOCK_REALTIME, &t);
  const auto ms = static_cast<std::uint64_t>(t.tv_sec) * 1000 + static_cast<std::uint64_t>(t.tv_nsec) / 1'000'000;
  return (ms << 22) ^ (static_cast<std::uint64_t>(::getpid()) << 10);
}

std::string words(const char* verb, std::uint32_t a) { return std::string(verb) + " " + std::to_string(a); }
std::string words(const char* verb, std::uint32_t a, std::uint32_t b) {
  return words(verb, a) + " " + std::to_string(b);
}

/// A start that is so long past is given anew: nobody who is still flying can have heard it.
constexpr Duration start_expired = std::chrono::seconds(2);
constexpr std::size_t joints_of_a_member = 2;

/// When a goal says that it begins; long ago when it does not.
template <class Message>
TimePoint start_of(const Message& message) {
  return std::visit(
      [](const auto& m) {
        if constexpr (requires { m.start_ns; }) return from_ns(m.start_ns);
        return TimePoint{};
      },
      message);
}

}  // namespace

std::string_view to_string(GoalProgress progress) {
  constexpr std::string_view names[] = {"unsent", "unanswered", "accepted", "succeeded", "refused", "aborted"};
  return names[static_cast<int>(progress)];
}

Operator::Operator(bus::Participant& swarm, const OperatorConfig& config)
    : config_(config),
      fleet_(swarm),
      next_correlation_id_(config.first_correlation_id != 0 ? config.first_correlation_id : drawn_correlation_id()),
      mode_request_(swarm.create_writer(topics::mode_request)),
      flight_goal_(swarm.create_writer(topics::flight_goal)),
      path_goal_(swarm.create_writer(topics::path_goal)),
      morph_goal_(swarm.create_writer(topics::morph_goal)),
      contact_goal_(swarm.create_writer(topics::contact_goal)),
      dock_goal_(swarm.create_writer(topics::dock_goal)),
      goal_status_(swarm.create_reader(topics::goal_status)) {}

std::uint64_t Operator::add(msg::GoalKind kind, std::string what, Message message) {
  const std::uint64_t id = next_correlation_id_++;
  std::visit([id](auto& m) { m.correlation_id = id; }, message);
  Goal& goal = goals_[id];
  goal.report = {.correlation_id = id,
                 .module_id = std::visit([](const auto& m) { return m.module_id; }, message),
                 .kind = kind,
                 .what = std::move(what),
                 .reason = {}};
  goal.message = message;
  goal.send_at = now_;
  return id;
}

std::uint64_t Operator::mode(std::uint32_t id, msg::ModeAction action) {
  const std::string verb(bus::EnumTraits<msg::ModeAction>::names[static_cast<std::size_t>(action)]);
  return add(msg::GoalKind::mode, words(verb.c_str(), id), msg::ModeRequest{.module_id = id, .action = action});
}

std::uint64_t Operator::take_off(std::uint32_t id, double height_m) {
  msg::FlightGoal goal{.module_id = id, .action = msg::FlightAction::takeoff};
  goal.p_WM_m = {0, 0, height_m};
  goal.q_WM = {1, 0, 0, 0};
  return add(msg::GoalKind::flight, words("takeoff", id), goal);
}

std::uint64_t Operator::go_to(std::uint32_t id, const std::array<double, 3>& p_WM_m, double yaw_rad,
                              double speed_m_s) {
  msg::FlightGoal goal{.module_id = id, .action = msg::FlightAction::goto_, .speed_m_s = speed_m_s};
  goal.p_WM_m = p_WM_m;
  goal.q_WM = {std::cos(yaw_rad / 2), 0, 0, std::sin(yaw_rad / 2)};
  return add(msg::GoalKind::flight, words("goto", id), goal);
}

std::uint64_t Operator::fly_path(std::uint32_t id, std::span<const msg::Waypoint> waypoints, double speed_m_s) {
  msg::PathGoal goal{.module_id = id, .speed_m_s = speed_m_s};
  const bool fits = std::all_of(waypoints.begin(), waypoints.end(),
                                [&](const msg::Waypoint& waypoint) { return goal.waypoints.push_back(waypoint); });
  const std::uint64_t correlation_id = add(msg::GoalKind::flight, words("path", id), goal);
  if (!fits) {
    refuse(correlation_id, std::to_string(waypoints.size()) + " waypoints; a path has at most " +
                               std::to_string(decltype(goal.waypoints)::bound()));
  }
  return correlation_id;
}

std::uint64_t Operator::land(std::uint32_t id) {
  msg::FlightGoal goal{.module_id = id, .action = msg::FlightAction::land};
  goal.q_WM = {1, 0, 0, 0};
  return add(msg::GoalKind::flight, words("land", id), goal);
}

std::uint64_t Operator::dock(std::uint32_t follower, std::uint32_t target) {
  return add(msg::GoalKind::dock, words("dock", follower, target),
             msg::DockGoal{.module_id = follower, .action = msg::DockAction::dock, .target_id = target});
}

std::uint64_t Operator::undock(std::uint32_t id, std::uint32_t peer) {
  return add(msg::GoalKind::dock, words("undock", id, peer),
             msg::DockGoal{.module_id = id, .action = msg::DockAction::undock, .target_id = peer});
}

std::uint64_t Operator::morph(std::uint32_t id, std::span<const double> joint_position_rad, double rate_rad_s) {
  msg::MorphGoal goal{.module_id = id, .rate_rad_s = rate_rad_s};
  bool fits = true;
  for (const double angle : joint_position_rad) fits = goal.joint_position_rad.push_back(angle) && fits;
  const std::uint64_t correlation_id = add(msg::GoalKind::morph, words("morph", id), goal);
  if (!fits) {
    refuse(correlation_id, std::to_string(joint_position_rad.size()) + " joint angles; a chain has at most " +
                               std::to_string(decltype(goal.joint_position_rad)::bound()));
  }
  return correlation_id;
}

std::uint64_t Operator::contact(std::uint32_t id, std::span<const msg::DesiredContact> links) {
  msg::ContactGoal goal{.module_id = id};
  const bool fits = std::all_of(links.begin(), links.end(),
                                [&](const msg::DesiredContact& link) { return goal.links.push_back(link); });
  const std::uint64_t correlation_id = add(msg::GoalKind::contact, words("contact", id), goal);
  if (!fits) {
    refuse(correlation_id, std::to_string(links.size()) + " contact wrenches; a chain has at most " +
                               std::to_string(decltype(goal.links)::bound()) + " links");
  }
  return correlation_id;
}

void Operator::refuse(std::uint64_t correlation_id, const std::string& reason) {
  GoalReport& report = goals_[correlation_id].report;
  report.progress = GoalProgress::refused;
  report.reason = reason;
}

void Operator::poll(TimePoint now) {
  now_ = now;
  fleet_.poll(now);
  take_answers();
  for (auto& [id, goal] : goals_) {
    if (goal.given_up || goal.report.progress > GoalProgress::unanswered || now < goal.send_at) continue;
    if (ready(goal)) send(goal);
  }
}

void Operator::take_answers() {
  while (const auto status = goal_status_.take()) {
    const auto found = goals_.find(status->value.correlation_id);
    if (found == goals_.end() || found->second.report.kind != status->value.goal) continue;
    if (!is_over(found->second.report.progress)) answer(found->second, status->value);
  }
}

bool Operator::is_chain_mate(std::uint32_t id, const Goal& goal) const {
  const KnownModule* module = fleet_.find(goal.report.module_id);
  if (module == nullptr || !module->in_chain()) return false;
  for (const std::uint32_t member : module->view->members) {
    if (member == id) return true;
  }
  return false;
}

void Operator::answer(Goal& goal, const msg::GoalStatus& status) {
  GoalReport& report = goal.report;
  std::string reason(status.reason.view());
  if (status.module_id != report.module_id) {
    // A chain does what all its members do: one that cannot ends it for all.
    const bool fails = status.phase == msg::GoalPhase::refused || status.phase == msg::GoalPhase::aborted;
    if (!fails || !is_chain_mate(status.module_id, goal)) return;
    reason = "module " + std::to_string(status.module_id) + ": " + reason;
  }
  switch (status.phase) {
    case msg::GoalPhase::accepted:
      report.progress = GoalProgress::accepted;
      break;
    case msg::GoalPhase::refused:
      report.progress = GoalProgress::refused;
      break;
    case msg::GoalPhase::succeeded:
      report.progress = GoalProgress::succeeded;
      break;
    case msg::GoalPhase::aborted:
      report.progress = GoalProgress::aborted;
      break;
  }
  report.reason = reason;
  const TimePoint stamp = from_ns(status.stamp_ns);
  if (report.accepted_at == TimePoint{}) report.accepted_at = stamp;
  report.starts_at = std::max(start_of(goal.message), report.accepted_at);
  if (is_over(report.progress)) report.ended_at = stamp;
}

bool Operator::ready(Goal& goal) {
  const auto* request = std::get_if<msg::ModeRequest>(&goal.message);
  if (request != nullptr && request->action == msg::ModeAction::stop) return true;
  if (goal.report.progress == GoalProgress::unanswered) return true;

  const KnownModule* module = fleet_.find(goal.report.module_id);
  if (module == nullptr) {
    goal.report.reason = "it is not heard on the swarm ring; heard: " + fleet_.heard();
    return false;
  }
  if (!fleet_.time_known()) {
    goal.report.reason = "its view is heard, but no state or beacon that says what time it is there";
    return false;
  }
  if (!module->view && now_ - module->first_heard < config_.view_patience) return false;
  if (!fits_the_chain(goal, *module)) return false;
  // A chain's members must all hear it, since they start together; and a match on our side comes before the
  // one on theirs.
  const std::size_t wanted = module->in_chain() ? module->view->members.size() : 1;
  if (std::visit([this](const auto& m) { return writer_of(m).matched(); }, goal.message) < wanted) {
    goal.matched = false;
    goal.report.reason = "its radio does not take goals yet";
    return false;
  }
  if (!goal.matched) {
    goal.matched = true;
    goal.matched_since = now_;
  }
  return wanted == 1 || now_ - goal.matched_since >= config_.match_patience;
}

bool Operator::fits_the_chain(Goal& goal, const KnownModule& module) {
  auto* morph = std::get_if<msg::MorphGoal>(&goal.message);
  if (morph == nullptr) return true;
  if (!module.settled()) {
    goal.report.reason = "its chain is being agreed on";
    return false;
  }
  const std::size_t members = std::max<std::size_t>(module.view->members.size(), 1);
  if (morph->joint_position_rad.size() == joints_of_a_member * members) return true;
  goal.report.progress = GoalProgress::refused;
  goal.report.reason = std::to_string(morph->joint_position_rad.size()) + " joint angles for a chain of " +
                       std::to_string(members) + "; expected " + std::to_string(joints_of_a_member * members) +
                       ": yaw and pitch of each member";
  return false;
}

void Operator::compose(Goal& goal, const KnownModule& module) {
  const std::int64_t start_ns = module.in_chain() ? to_ns(module_now() + config_.chain_lead) : 0;
  // A repetition keeps its start: a member that missed the first one joins the others where they are.
  const auto set_start = [&](auto& m) {
    if (m.start_ns == 0 || from_ns(m.start_ns) + start_expired < module_now()) m.start_ns = start_ns;
  };
  const std::uint64_t epoch = module.view ? module.view->active_epoch : 0;
  if (auto* flight = std::get_if<msg::FlightGoal>(&goal.message)) set_start(*flight);
  if (auto* path = std::get_if<msg::PathGoal>(&goal.message)) set_start(*path);
  if (auto* contact = std::get_if<msg::ContactGoal>(&goal.message)) contact->epoch = epoch;
  if (auto* morph = std::get_if<msg::MorphGoal>(&goal.message)) {
    set_start(*morph);
    morph->epoch = epoch;
  }
}

void Operator::send(Goal& goal) {
  if (const KnownModule* module = fleet_.find(goal.report.module_id)) compose(goal, *module);
  const auto* request = std::get_if<msg::ModeRequest>(&goal.message);
  const bool stop = request != nullptr && request->action == msg::ModeAction::stop;
  goal.send_at = now_ + (stop ? config_.stop_resend : config_.resend);
  goal.report.progress = GoalProgress::unanswered;
  goal.report.reason = "it does not answer";
  ++goal.report.sent;
  std::visit(
      [&](auto& m) {
        m.stamp_ns = to_ns(module_now());
        writer_of(m).write(m);
      },
      goal.message);
}

const GoalReport* Operator::report(std::uint64_t correlation_id) const {
  const auto found = goals_.find(correlation_id);
  return found == goals_.end() ? nullptr : &found->second.report;
}

void Operator::give_up(std::uint64_t correlation_id) {
  if (const auto found = goals_.find(correlation_id); found != goals_.end()) found->second.given_up = true;
}

}  // namespace eciton::deploy
