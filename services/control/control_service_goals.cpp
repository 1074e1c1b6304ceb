// What operators and the docking service ask of control: judged, answered, begun.
#include <algorithm>

#include "core/robot/arrays.hpp"
#include "services/control/control_service.hpp"

namespace eciton::control {
namespace {

/// A tracked reference goes along the fence, not through it.
void keep_inside(const Fence& fence, robot::PoseReference& moving) {
  for (int k = 0; k < 3; ++k) {
    const double inside = std::clamp(moving.p_WM[k], fence.low_W[k], std::max(fence.low_W[k], fence.high_W[k]));
    if (inside != moving.p_WM[k]) moving.v_WM[k] = 0;
    moving.p_WM[k] = inside;
  }
}

}  // namespace

void ControlService::take_requests(TimePoint now) noexcept {
  while (const auto sample = mode_request_.take()) {
    const msg::ModeRequest& request = sample->value;
    if (request.module_id != config_.module_id || request.correlation_id == answered_mode_) continue;
    answered_mode_ = request.correlation_id;
    FlightDecision decision{.mode = mode_};
    switch (request.action) {
      case msg::ModeAction::arm:
        decision = decide(mode_, FlightRequest::arm, conditions_);
        break;
      case msg::ModeAction::disarm:
        decision = decide(mode_, FlightRequest::disarm, conditions_);
        break;
      case msg::ModeAction::stop:
        decision = decide(mode_, FlightRequest::stop, conditions_);
        break;
      case msg::ModeAction::zero:
        continue;  // estimation's, which answers it
    }
    mode_ = decision.mode;
    answer(msg::GoalKind::mode, request.correlation_id,
           decision.accepted ? msg::GoalPhase::succeeded : msg::GoalPhase::refused, decision.reason, now);
  }
}

void ControlService::take_goals(TimePoint now) noexcept {
  while (const auto sample = flight_goal_.take()) take_flight_goal(sample->value, now);
  while (const auto sample = path_goal_.take()) take_path_goal(sample->value, now);
  while (const auto sample = morph_goal_.take()) take_morph_goal(sample->value, now);
  while (const auto sample = contact_goal_.take()) take_contact_goal(sample->value, now);
  while (const auto sample = docking_reference_.take()) take_docking_reference(sample->value, now - sample->age, now);
}

bool ControlService::concerns_us(std::uint32_t module_id) const {
  // A goal to a member of a chain is for the chain; only the member it names answers.
  return module_id == config_.module_id || (in_chain() && is_member(module_id));
}

double ControlService::start_s(std::int64_t start_ns, TimePoint now) const {
  return std::max(seconds(now), seconds(from_ns(start_ns)));
}

void ControlService::take_flight_goal(const msg::FlightGoal& goal, TimePoint now) noexcept {
  if (!concerns_us(goal.module_id) || goal.correlation_id == answered_flight_) return;
  const FlightDecision decision = decide_goal(goal, now);
  answer_flight(goal.module_id, goal.correlation_id, decision, now);
  if (decision.accepted) begin(goal, now);
}

FlightDecision ControlService::decide_goal(const msg::FlightGoal& goal, TimePoint now) noexcept {
  switch (goal.action) {
    case msg::FlightAction::takeoff: {
      const FlightDecision decision = decide(mode_, FlightRequest::takeoff, conditions_);
      if (!decision.accepted) return decision;
      if (const auto fault = check_takeoff(motion_.p_WM, goal.p_WM_m[2], goal_limits())) return refuse(*fault);
      return decision;
    }
    case msg::FlightAction::goto_: {
      const FlightDecision decision = decide_motion();
      if (!decision.accepted) return decision;
      if (const auto fault = check_fields(goal, now)) return refuse(*fault);
      const robot::Pose X_goal{robot::vector(goal.p_WM_m), robot::rotation(goal.q_WM)};
      const double start = start_s(goal.start_ns, now);
      if (const auto fault = check_way(reference_.way_to(X_goal, goal.speed_m_s, start, seconds(now)))) {
        return refuse(*fault);
      }
      return decision;
    }
    case msg::FlightAction::land:
      if (in_chain()) return {mode_, false, "a chain does not land: undock first"};
      return decide(mode_, FlightRequest::land, conditions_);
  }
  return {mode_, false, "unknown action"};
}

FlightDecision ControlService::decide_motion() const noexcept {
  if (is_docking(docking_now())) {
    return {mode_, false, "docking is under way: wait until it is done"};
  }
  return decide(mode_, FlightRequest::go_to, conditions_);
}

GoalLimits ControlService::goal_limits() const {
  return {.fence = {robot::vector(config_.fence_low_m), robot::vector(config_.fence_high_m)},
          .height_m_min = config_.height_m_min};
}

FlightDecision ControlService::refuse(const GoalFault& fault) noexcept {
  refusal_ = fault;
  return {mode_, false, refusal_.text.data()};
}

std::optional<GoalFault> ControlService::check_fields(const msg::FlightGoal& goal, TimePoint now) const noexcept {
  const GoalLimits limits = goal_limits();
  if (const auto fault = check_pose(goal.p_WM_m, goal.q_WM, 0, limits)) return fault;
  if (const auto fault = check_speed(goal.speed_m_s, limits)) return fault;
  return check_start(to_s(from_ns(goal.start_ns) - now), limits);
}

std::optional<GoalFault> ControlService::check_fields(const msg::PathGoal& goal, TimePoint now) const noexcept {
  const GoalLimits limits = goal_limits();
  for (std::size_t k = 0; k < goal.waypoints.size(); ++k) {
    if (const auto fault = check_pose(goal.waypoints[k].p_WM_m, goal.waypoints[k].q_WM, k + 1, limits)) return fault;
  }
  if (const auto fault = check_speed(goal.speed_m_s, limits)) return fault;
  return check_start(to_s(from_ns(goal.start_ns) - now), limits);
}

template <class Way>
std::optional<GoalFault> ControlService::check_way(const Way& way) noexcept {
  // Where it stands it stands: the beginning is not asked about, only that what follows is no lower.
  constexpr int samples = 40;
  const GoalLimits limits = goal_limits();
  const robot::Vector3 c_B = robot::com_offset_B(airframe_, joint_angles());
  std::array<robot::PoseReference, robot::members_max> members;
  double height_m_low = limits.height_m_min;
  for (int k = 0; k <= samples; ++k) {
    const double t_s = way.start_s() + way.duration_s() * k / samples;
    const std::span at = std::span(members).first(reference_.members_on(way.at(t_s), t_s, members));
    if (k == 0) {
      for (const robot::PoseReference& m : at) height_m_low = std::min(height_m_low, m.p_WM.z());
    } else if (const auto fault = check_moment(at, height_m_low, limits, c_B, reach_)) {
      return fault;
    }
  }
  return std::nullopt;
}

void ControlService::answer_flight(std::uint32_t module_id, std::uint64_t correlation_id,
                                   const FlightDecision& decision, TimePoint now) noexcept {
  answered_flight_ = correlation_id;
  mode_ = decision.mode;
  const bool ours = module_id == config_.module_id;
  if (ours) {
    answer(msg::GoalKind::flight, correlation_id,
           decision.accepted ? msg::GoalPhase::accepted : msg::GoalPhase::refused, decision.reason, now);
  }
  if (!decision.accepted) return;
  goal_id_ = correlation_id;
  goal_is_ours_ = ours;
  goal_pending_ = true;
}

void ControlService::begin(const msg::FlightGoal& goal, TimePoint now) noexcept {
  const double now_s = seconds(now);
  see_base(now);
  const robot::Pose X_goal{robot::vector(goal.p_WM_m), robot::rotation(goal.q_WM)};
  switch (goal.action) {
    case msg::FlightAction::takeoff:
      pose_control_.reset();
      separation_.reset();
      neighbourhood_.accept_those_near(motion_.p_WM, separation_.config().distance_m, now);
      reference_.hold({motion_.p_WM, motion_.R_WM});
      reference_.move({{motion_.p_WM.x(), motion_.p_WM.y(), goal.p_WM_m[2]}, robot::upright(motion_.R_WM)},
                      config_.takeoff_m_s, now_s, now_s);
      break;
    case msg::FlightAction::goto_:
      reference_.move(X_goal, goal.speed_m_s, start_s(goal.start_ns, now), now_s);
      break;
    case msg::FlightAction::land:
      touchdown_.reset();
      reference_.descend(config_.landing_m_s, now_s);
      break;
  }
}

void ControlService::take_path_goal(const msg::PathGoal& goal, TimePoint now) noexcept {
  if (!concerns_us(goal.module_id) || goal.correlation_id == answered_flight_) return;
  FlightDecision decision = decide_motion();
  if (decision.accepted && goal.waypoints.empty()) decision = {mode_, false, "a path without waypoints"};
  if (decision.accepted && !reference_.at_rest(seconds(now))) {
    decision = {mode_, false, "still moving: a path begins at rest"};
  }
  if (decision.accepted) {
    if (const auto fault = check_fields(goal, now)) decision = refuse(*fault);
  }
  std::array<robot::Pose, decltype(goal.waypoints)::bound()> waypoints;
  for (std::size_t k = 0; k < goal.waypoints.size(); ++k) {
    waypoints[k] = {robot::vector(goal.waypoints[k].p_WM_m), robot::rotation(goal.waypoints[k].q_WM)};
  }
  see_base(now);
  const std::span through = std::span<const robot::Pose>(waypoints).first(goal.waypoints.size());
  const double start = start_s(goal.start_ns, now);
  if (decision.accepted) {
    const auto fault = check_way(reference_.way_through(through, goal.speed_m_s, start, seconds(now)));
    if (fault) decision = refuse(*fault);
  }
  answer_flight(goal.module_id, goal.correlation_id, decision, now);
  if (decision.accepted) reference_.follow(through, goal.speed_m_s, start, seconds(now));
}

void ControlService::take_morph_goal(const msg::MorphGoal& goal, TimePoint now) noexcept {
  if (!in_chain() || goal.epoch != view_.active_epoch || goal.correlation_id == answered_morph_) return;
  answered_morph_ = goal.correlation_id;
  // The joints service of the member it names answers; it comes to the same verdict.
  if (is_docking(docking_now())) return;
  const std::span<const double> joint_rad(goal.joint_position_rad.data(), goal.joint_position_rad.size());
  see_base(now);
  static_cast<void>(reference_.morph(joint_rad, goal.rate_rad_s, start_s(goal.start_ns, now), seconds(now)));
}

void ControlService::take_contact_goal(const msg::ContactGoal& goal, TimePoint now) noexcept {
  if (!concerns_us(goal.module_id) || goal.correlation_id == answered_contact_) return;
  answered_contact_ = goal.correlation_id;
  const char* refusal = nullptr;
  if (!in_chain()) {
    refusal = "not in a chain: dock first";
  } else if (goal.epoch != view_.active_epoch) {
    refusal = "the chain has changed since this goal was made: look and ask again";
  } else if (!goal.links.empty() && goal.links.size() != view_.members.size() - 1) {
    refusal = "give one contact wrench per link of the chain, or none";
  } else if (!std::all_of(goal.links.begin(), goal.links.end(), [](const msg::DesiredContact& link) {
               return robot::vector(link.force_M_N).allFinite() && robot::vector(link.moment_M_Nm).allFinite();
             })) {
    refusal = "a contact wrench is not finite";
  }
  if (refusal == nullptr) contact_goal_now_ = goal;
  if (goal.module_id != config_.module_id) return;
  answer(msg::GoalKind::contact, goal.correlation_id,
         refusal == nullptr ? msg::GoalPhase::succeeded : msg::GoalPhase::refused, refusal == nullptr ? "" : refusal,
         now);
}

void ControlService::take_docking_reference(const msg::DockingReference& reference, TimePoint at,
                                            TimePoint now) noexcept {
  const bool alone = reference.epoch == 0 && reference.module_id == config_.module_id && !in_chain();
  const bool of_chain =
      reference.epoch != 0 && in_chain() && reference.epoch == view_.active_epoch && is_member(reference.module_id);
  if (!alone && !of_chain) return;
  if (!decide(mode_, FlightRequest::go_to, conditions_).accepted) return;
  if (!is_pose(reference.p_WM_m, reference.q_WM)) {
    ++rejected_;
    if (!bad_reference_) {
      faults_.raise(now, msg::Severity::warning, "docking",
                    "a docking reference that is no pose: the last one is held");
    }
    bad_reference_ = true;
    return;
  }
  bad_reference_ = false;
  mode_ = FlightMode::hover;
  goal_pending_ = false;
  robot::PoseReference moving;
  moving.p_WM = robot::vector(reference.p_WM_m);
  moving.R_WM = robot::rotation(reference.q_WM);
  moving.v_WM = robot::vector(reference.v_WM_m_s);
  moving.w_WM_M = robot::vector(reference.w_WM_M_rad_s);
  see_base(now);
  keep_inside(goal_limits().fence, moving);
  reference_.track(moving, seconds(at));
}

void ControlService::answer(msg::GoalKind kind, std::uint64_t correlation_id, msg::GoalPhase phase,
                            std::string_view reason, TimePoint now) noexcept {
  msg::GoalStatus out;
  out.module_id = config_.module_id;
  out.goal = kind;
  out.stamp_ns = to_ns(now);
  out.correlation_id = correlation_id;
  out.phase = phase;
  out.reason = reason;
  goal_status_.write(out);
}

}  // namespace eciton::control
