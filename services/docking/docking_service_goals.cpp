// What operators ask of docking: judged, begun here or handed on to the end of our chain, answered.
#include <algorithm>

#include "services/docking/docking_service.hpp"

namespace eciton::docking {
namespace {

constexpr Duration take_up_time_out = std::chrono::seconds(3);  // of a chain mate, for what was handed on to it

}  // namespace

void DockingService::take_goals(TimePoint now) noexcept {
  while (const auto sample = dock_goal_.take()) {
    const msg::DockGoal& goal = sample->value;
    if (goal.module_id != config_.module_id || goal.correlation_id == answered_) continue;
    answered_ = goal.correlation_id;
    if (goal.action == msg::DockAction::dock) {
      dock(goal, now);
    } else {
      undock(goal, now);
    }
  }
  take_handed_on(now);
}

Candidate DockingService::candidate(std::uint32_t id, TimePoint now) const {
  Candidate c{.module = id};
  const HeardModule* module = heard_.find(id);
  if (module == nullptr || module->heard == TimePoint{}) return c;
  const bool own_one = id == config_.module_id;
  const msg::DockingPhase phase = own_one ? state_.phase : module->docking.phase;
  c.known = true;
  c.fresh = own_one || is_fresh(*module, now);
  c.flying = module->flying;
  c.docking = (phase != msg::DockingPhase::idle && phase != msg::DockingPhase::docked) ||
              (own_one && handed_on_.goal_id != 0);
  c.zeroed = module->zeroed || !config_.require_zeroed;
  return c;
}

void DockingService::add_side(std::uint32_t named, BoundedVector<Candidate, chain::max_modules>& side,
                              TimePoint now) const {
  side.push_back(candidate(named, now));
  BoundedVector<std::uint32_t, chain::max_modules> component;
  chain::component_of(named, membership_.agreement().graph(), component);
  for (const std::uint32_t member : component) {
    if (member != named) side.push_back(candidate(member, now));
  }
}

DockAnswer DockingService::judge(std::uint32_t target_id, const std::optional<PortChoice>& choice,
                                 TimePoint now) const {
  BoundedVector<Candidate, chain::max_modules> followers, targets;
  add_side(config_.module_id, followers, now);
  add_side(target_id, targets, now);
  const bool same_chain =
      std::any_of(targets.begin(), targets.end(), [&](const Candidate& c) { return c.module == config_.module_id; });
  const DockAnswer verdict = refuse_dock({followers.data(), followers.size()}, {targets.data(), targets.size()},
                                         same_chain, choice.has_value());
  if (verdict.refusal != DockRefusal::none) return verdict;
  const std::optional<chain::View>& active = membership_.agreement().active();
  const std::optional<chain::View>& held = membership_.agreement().held();
  const bool settled = active && held && active->epoch == held->epoch;
  return settled ? DockAnswer{} : DockAnswer{DockRefusal::unsettled, config_.module_id};
}

void DockingService::add_free_ports(std::uint32_t module_id, TimePoint now,
                                    BoundedVector<FreePort, 2 * robot::members_max>& ports) const {
  const HeardModule* m = heard_.find(module_id);
  if (m == nullptr) return;
  for (std::uint32_t port = 0; port < airframe_.ports.size(); ++port) {
    if (membership_.linked(module_id, port)) continue;
    ports.push_back({.module = module_id,
                     .port = port,
                     .kind = airframe_.ports[port].kind,
                     .X_WP = heard_.port_pose_W(*m, port, now)});
  }
}

void DockingService::dock(const msg::DockGoal& goal, TimePoint now) noexcept {
  BoundedVector<FreePort, 2 * robot::members_max> own_ports, target_ports;
  const chain::LinkGraph& graph = membership_.agreement().graph();
  for (auto [module, ports] : {std::pair(config_.module_id, &own_ports), std::pair(goal.target_id, &target_ports)}) {
    BoundedVector<std::uint32_t, chain::max_modules> component;
    chain::component_of(module, graph, component);
    for (const std::uint32_t member : component) add_free_ports(member, now, *ports);
  }
  const auto choice = choose_ports({own_ports.data(), own_ports.size()}, {target_ports.data(), target_ports.size()},
                                   config_.sequence.standoff_m);
  const DockAnswer verdict = judge(goal.target_id, choice, now);
  if (verdict.refusal != DockRefusal::none) {
    answer(goal.correlation_id, msg::GoalPhase::refused, verdict.text().view(), now);
    return;
  }
  if (choice->follower.module == config_.module_id) {
    begin_docking(*choice, goal.correlation_id, now);
  } else {
    handed_on_ = {.goal_id = goal.correlation_id,
                  .member = choice->follower.module,
                  .pairing = {choice->target.module, choice->follower.port, choice->target.port},
                  .since = now};
  }
  answer(goal.correlation_id, msg::GoalPhase::accepted, "", now);
}

void DockingService::begin_docking(const PortChoice& choice, std::uint64_t goal_id, TimePoint now) noexcept {
  pairing_ = {choice.target.module, choice.follower.port, choice.target.port};
  membership_.expect(pairing_.port, pairing_.peer, pairing_.peer_port);
  X_WT_.start(choice.target.X_WP);
  trim_W_.setZero();
  push_bias_N_ = 0;
  BoundedVector<robot::Vector3, ApproachPath::carried_max> mates_F;
  for (const HeardModule& m : heard_.all()) {
    if (m.id == config_.module_id || !is_member(m.id)) continue;
    mates_F.push_back(choice.follower.X_WP.inverse() * heard_.body_pose_W(m, now).p);
  }
  follower_.start_docking(choice.target.kind, choice.target.X_WP.inverse() * choice.follower.X_WP,
                          {mates_F.data(), mates_F.size()});
  role_ = msg::DockingRole::follower;
  is_target_ = false;
  following_ = goal_pending_ = true;
  goal_id_ = goal_id;
}

void DockingService::take_handed_on(TimePoint now) noexcept {
  if (chain() == nullptr || under_way()) return;
  for (const std::uint32_t id : chain()->members) {
    const HeardModule* mate = id == config_.module_id ? nullptr : heard_.find(id);
    if (mate == nullptr || !is_fresh(*mate, now)) continue;
    const msg::DockingState& d = mate->docking;
    const bool hands_on = d.role == msg::DockingRole::none && d.correlation_id != 0;
    // Of a chain's free ports one is male and one is female: whoever owns the one that is named is meant.
    // With the target in our chain it is done already.
    if (!hands_on || d.correlation_id == taken_over_ || is_member(d.peer_id) || d.port >= airframe_.ports.size() ||
        d.peer_port >= airframe_.ports.size() || membership_.linked(config_.module_id, d.port)) {
      continue;
    }
    taken_over_ = d.correlation_id;
    BoundedVector<FreePort, 2 * robot::members_max> own_ports, target_ports;
    add_free_ports(config_.module_id, now, own_ports);
    add_free_ports(d.peer_id, now, target_ports);
    const auto named = [](const auto& ports, std::uint32_t port) {
      return std::find_if(ports.begin(), ports.end(), [port](const FreePort& p) { return p.port == port; });
    };
    const auto own = named(own_ports, d.port), target = named(target_ports, d.peer_port);
    std::optional<PortChoice> choice;
    if (own != own_ports.end() && target != target_ports.end()) choice = PortChoice{*own, *target};
    const DockAnswer verdict = judge(d.peer_id, choice, now);
    if (verdict.refusal != DockRefusal::none) {
      answer(d.correlation_id, msg::GoalPhase::refused, verdict.text().view(), now);
      return;
    }
    begin_docking(*choice, d.correlation_id, now);
    return;
  }
}

void DockingService::watch_handed_on(TimePoint now) noexcept {
  if (handed_on_.goal_id == 0) return;
  const auto end = [&](msg::GoalPhase phase, std::string_view reason) {
    answer(handed_on_.goal_id, phase, reason, now);
    handed_on_ = {};
  };
  const HeardModule* member = heard_.find(handed_on_.member);
  const msg::DockingState& d = member->docking;
  if (d.correlation_id == handed_on_.goal_id && d.role == msg::DockingRole::follower) {
    handed_on_.begun = true;
    handed_on_.since = now;
    if (d.phase == msg::DockingPhase::docked) end(msg::GoalPhase::succeeded, "");
  } else if (handed_on_.begun) {
    end(msg::GoalPhase::aborted, "the member of our chain that had the port gave up");
  } else if (now - handed_on_.since > take_up_time_out) {
    end(msg::GoalPhase::aborted, "the member of our chain that has the port did not take it up");
  }
}

void DockingService::end_interrupted(TimePoint now) noexcept {
  for (std::uint64_t& goal_id : interrupted_) {
    if (goal_id != 0) answer(goal_id, msg::GoalPhase::aborted, "the docking service was started anew", now);
    goal_id = 0;
  }
}

void DockingService::undock(const msg::DockGoal& goal, TimePoint now) noexcept {
  if (under_way()) {
    const DockAnswer busy{DockRefusal::already_docking, config_.module_id};
    answer(goal.correlation_id, msg::GoalPhase::refused, busy.text().view(), now);
    return;
  }
  for (std::uint32_t port = 0; port < airframe_.ports.size(); ++port) {
    const auto link = membership_.link_of(port);
    if (!link || link->peer != goal.target_id) continue;
    const HeardModule* peer = heard_.find(goal.target_id);
    if (peer == nullptr) break;
    pairing_ = {goal.target_id, port, link->peer_port};
    const robot::Pose X_WT = heard_.port_pose_W(*peer, pairing_.peer_port, now);
    X_WT_.start(X_WT);
    trim_W_.setZero();
    const robot::Pose X_WF = heard_.port_pose_W(heard_.own(), port, now);
    follower_.start_undocking(airframe_.ports[pairing_.peer_port].kind, X_WT.inverse() * X_WF);
    role_ = msg::DockingRole::follower;
    is_target_ = false;
    following_ = goal_pending_ = true;
    goal_id_ = goal.correlation_id;
    answer(goal_id_, msg::GoalPhase::accepted, "", now);
    return;
  }
  answer(goal.correlation_id, msg::GoalPhase::refused, "no link to that module", now);
}

void DockingService::answer(std::uint64_t correlation_id, msg::GoalPhase phase, std::string_view reason,
                            TimePoint now) noexcept {
  msg::GoalStatus out;
  out.module_id = config_.module_id;
  out.goal = msg::GoalKind::dock;
  out.stamp_ns = to_ns(now);
  out.correlation_id = correlation_id;
  out.phase = phase;
  out.reason = reason;
  goal_status_.write(out);
}

}  // namespace eciton::docking
