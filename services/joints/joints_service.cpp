// take(); follow; write.
#include "services/joints/joints_service.hpp"

#include <algorithm>

#include "core/robot/arrays.hpp"

namespace eciton::joints {
namespace {

constexpr Duration docking_silence = std::chrono::seconds(1);  // while it docks a module says so 20 times a second

template <class Members>
bool contains(const Members& members, std::uint32_t module_id) {
  return std::find(members.begin(), members.end(), module_id) != members.end();
}

}  // namespace

JointsService::JointsService(bus::Participant& ring, const JointsConfig& config, const robot::Airframe& airframe)
    : config_(config),
      airframe_(airframe),
      trajectory_(airframe),
      morph_goal_(ring.create_reader(topics::morph_goal)),
      chain_view_(ring.create_reader(topics::chain_view)),
      joint_state_(ring.create_reader(topics::joint_state)),
      contact_goal_(ring.create_reader(topics::contact_goal)),
      module_state_(ring.create_reader(topics::module_state)),
      docking_state_(ring.create_reader(topics::docking_state)),
      joint_command_(ring.create_writer(topics::joint_command)),
      goal_status_(ring.create_writer(topics::goal_status)) {
  relief_.fill(JointRelief(config.relief));
}

void JointsService::step(TimePoint now) noexcept {
  if (first_step_) begin(now);
  first_step_ = false;
  while (const auto state = module_state_.take()) {
    if (state->value.module_id == config_.module_id) R_WM_ = robot::rotation(state->value.q_WM);
  }
  while (const auto sample = contact_goal_.take()) {
    const msg::ContactGoal& goal = sample->value;
    if (contains(view_.members, goal.module_id)) loaded_epoch_ = goal.links.empty() ? 0 : goal.epoch;
  }
  take_joints(now);
  take_chain(now);
  take_docking(now);
  take_goals(now);
  if (measured_) write(now);
  last_step_ = now;
}

void JointsService::load_state(runtime::StateReader& reader) noexcept {
  visit_state(*this, reader);
  loaded_ = true;
}

void JointsService::begin(TimePoint now) noexcept {
  if (loaded_ && now - last_step_ <= runtime::resume_within) return;
  epoch_ = now;
  measured_ = in_chain_ = goal_pending_ = false;
  view_ = {};
}

void JointsService::take_joints(TimePoint now) noexcept {
  while (const auto sample = joint_state_.take()) {
    const msg::JointState& state = sample->value;
    if (state.joints.size() != airframe_.joints.size()) continue;
    if (state.module_id != config_.module_id) {
      auto slot = std::find_if(heard_.begin(), heard_.end(), [&](const msg::JointState& s) {
        return s.module_id == state.module_id || s.module_id == 0;
      });
      if (slot != heard_.end()) *slot = state;
      continue;
    }
    own_ = state;
    if (measured_) continue;
    measured_ = true;
    straighten(now);
  }
}

void JointsService::straighten(TimePoint now) noexcept {
  // From where they stand, so that neither a restart nor leaving a chain makes them jump.
  std::array<double, robot::joints_max> position_rad{};
  const std::size_t each = airframe_.joints.size();
  for (std::size_t k = 0; k < each; ++k) {
    position_rad[k] =
        in_chain_ ? trajectory_.at(place_ * each + k, seconds(now)).position : own_.joints[k].position_rad;
  }
  in_chain_ = false;
  place_ = 0;
  const std::span<const double> from(position_rad.data(), each);
  trajectory_.reset(from, 0);
  const std::array<double, robot::joints_max> zero{};
  static_cast<void>(trajectory_.go(std::span(zero).first(each), 0, seconds(now), seconds(now)));
}

void JointsService::take_chain(TimePoint now) noexcept {
  while (const auto sample = chain_view_.take()) {
    const msg::ChainView& view = sample->value;
    if (view.module_id != config_.module_id || !view.active || !measured_) continue;
    const bool changed = view.active_epoch != view_.active_epoch;
    view_ = view;
    if (!changed) continue;
    if (goal_pending_) answer(goal_, msg::GoalPhase::aborted, "the chain changed on the way", now);
    goal_pending_ = false;
    if (view.members.size() > 1) {
      enter_chain(now);
    } else {
      straighten(now);
    }
  }
}

void JointsService::enter_chain(TimePoint now) noexcept {
  // Our own joints as they are commanded, the others' as measured: their share only sets the time all take.
  const std::size_t each = airframe_.joints.size();
  std::array<double, robot::coordinates_max> position_rad{};
  const std::size_t own_before = place_;
  for (std::size_t i = 0; i < view_.members.size(); ++i) {
    const std::uint32_t id = view_.members[i];
    const auto heard =
        std::find_if(heard_.begin(), heard_.end(), [id](const msg::JointState& s) { return s.module_id == id; });
    for (std::size_t k = 0; k < each; ++k) {
      double& angle_rad = position_rad[i * each + k];
      if (id == config_.module_id) {
        angle_rad = trajectory_.at(own_before * each + k, seconds(now)).position;
        place_ = i;
      } else if (heard != heard_.end()) {
        angle_rad = heard->joints[k].position_rad;
      }
    }
  }
  in_chain_ = true;
  trajectory_.reset(std::span<const double>(position_rad.data(), view_.members.size() * each),
                    (view_.members.size() + 1) / 2 - 1);
}

void JointsService::take_docking(TimePoint now) noexcept {
  while (const auto sample = docking_state_.take()) {
    const msg::DockingState& d = sample->value;
    if (d.phase != msg::DockingPhase::idle && d.phase != msg::DockingPhase::docked) {
      if (d.module_id != config_.module_id && !contains(view_.members, d.module_id)) continue;
      docking_member_ = d.module_id;
      docking_at_ = now - sample->age;
    } else if (d.module_id == docking_member_) {
      docking_member_ = 0;
    }
  }
  if (now - docking_at_ > docking_silence) docking_member_ = 0;
}

void JointsService::take_goals(TimePoint now) noexcept {
  while (const auto sample = morph_goal_.take()) {
    const msg::MorphGoal& goal = sample->value;
    const bool ours = goal.module_id == config_.module_id || contains(view_.members, goal.module_id);
    if (!ours || goal.correlation_id == answered_) continue;
    answered_ = goal.correlation_id;
    if (!in_chain_) {
      answer(goal, msg::GoalPhase::refused, "not in a chain: dock first", now);
      continue;
    }
    if (goal.epoch != view_.active_epoch) {
      answer(goal, msg::GoalPhase::refused, "the chain has changed since this goal was made: look and ask again",
             now);
      continue;
    }
    if (docking_member_ != 0) {
      answer(goal, msg::GoalPhase::refused, "docking is under way: wait until it is done", now);
      continue;
    }
    // Every member plans the whole chain's motion, so that all take the same time.
    const std::span<const double> target(goal.joint_position_rad.data(), goal.joint_position_rad.size());
    const double start_s = std::max(seconds(now), seconds(from_ns(goal.start_ns)));
    if (const auto fault = trajectory_.go(target, goal.rate_rad_s, seconds(now), start_s)) {
      std::array<char, 128> text{};
      answer(goal, msg::GoalPhase::refused, fault->describe(text.data(), text.size()), now);
      continue;
    }
    goal_ = goal;
    goal_pending_ = true;
    answer(goal, msg::GoalPhase::accepted, "", now);
  }
}

void JointsService::write(TimePoint now) noexcept {
  const std::size_t each = airframe_.joints.size();
  const double dt_s = std::clamp(to_s(now - last_step_), 0.0, 0.05);
  msg::JointCommand out;
  out.module_id = config_.module_id;
  out.stamp_ns = to_ns(now);
  for (std::size_t k = 0; k < each; ++k) {
    const robot::ScalarMotion joint = trajectory_.at(place_ * each + k, seconds(now));
    const double give_rad = gives_way(k)
                                ? relief_[k].update(own_.joints[k].torque_Nm -
                                                        weight_torque_Nm(airframe_.joints[k], joint.position, R_WM_),
                                                    joint.velocity, dt_s)
                                : relief_[k].let_go(dt_s);
    out.joints.push_back({joint.position + give_rad, joint.velocity, 0});
  }
  joint_command_.write(out);
  if (goal_pending_ && trajectory_.finished(seconds(now))) {
    goal_pending_ = false;
    answer(goal_, msg::GoalPhase::succeeded, "", now);
  }
}

bool JointsService::gives_way(std::size_t joint) const {
  if (!in_chain_ || loaded_epoch_ == view_.active_epoch) return false;
  // The male port holds the next member, the female one the member before.
  return std::any_of(airframe_.ports.begin(), airframe_.ports.end(), [&](const robot::PortGeometry& port) {
    const bool linked = port.kind == robot::PortKind::male ? place_ + 1 < view_.members.size() : place_ > 0;
    return linked && static_cast<std::size_t>(port.joint) == joint;
  });
}

void JointsService::answer(const msg::MorphGoal& goal, msg::GoalPhase phase, std::string_view reason,
                           TimePoint now) noexcept {
  if (goal.module_id != config_.module_id) return;
  msg::GoalStatus out;
  out.module_id = config_.module_id;
  out.goal = msg::GoalKind::morph;
  out.stamp_ns = to_ns(now);
  out.correlation_id = goal.correlation_id;
  out.phase = phase;
  out.reason = reason;
  goal_status_.write(out);
}

}  // namespace eciton::joints
