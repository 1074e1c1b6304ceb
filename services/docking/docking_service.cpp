// take(); sequence; write.
#include "services/docking/docking_service.hpp"

#include <algorithm>
#include <cmath>

#include "core/robot/arrays.hpp"

namespace eciton::docking {
namespace {

constexpr chain::FreshnessConfig freshness;

bool in_the_air(msg::FlightMode mode) { return mode == msg::FlightMode::hover || mode == msg::FlightMode::move; }

}  // namespace

DockingService::DockingService(bus::Participant& ring, const DockingServiceConfig& config,
                               const robot::Airframe& airframe)
    : config_(config),
      airframe_(airframe),
      ring_(ring),
      membership_(ring, {.module_id = config.module_id,
                         .incarnation = config.incarnation,
                         .ports = static_cast<std::uint32_t>(airframe.ports.size()),
                         .claims_muted = config.claims_muted,
                         .start_margin_s = config.start_margin_s}),
      follower_(config.sequence),
      target_(config.target),
      dock_goal_(ring.create_reader(topics::dock_goal)),
      module_states_(ring.create_reader(topics::module_state)),
      joint_states_(ring.create_reader(topics::joint_state)),
      external_wrenches_(ring.create_reader(topics::external_wrench)),
      docking_states_(ring.create_reader(topics::docking_state)),
      beacons_(ring.create_reader(topics::beacon)),
      heartbeats_(ring.create_reader(topics::heartbeat)),
      docking_reference_(ring.create_writer(topics::docking_reference)),
      latch_command_(ring.create_writer(topics::latch_command)),
      docking_state_(ring.create_writer(topics::docking_state)),
      goal_status_(ring.create_writer(topics::goal_status)),
      event_(ring.create_writer(topics::event)) {
  modules_[0].id = config.module_id;
}

void DockingService::step(TimePoint now) noexcept {
  const double dt_s = first_step_ ? 0 : std::clamp(to_s(now - last_step_), 0.0, 0.1);
  take(now);
  update_membership(now);
  take_goals(now);
  if (following_) follow(now, dt_s);
  be_target(now, dt_s);
  write_state(now);
  last_step_ = now;
  first_step_ = false;
}

DockingService::Module* DockingService::find(std::uint32_t id) noexcept {
  for (Module& m : modules_) {
    if (m.id == id) return &m;
    if (m.id != 0) continue;
    m.id = id;
    return &m;
  }
  return nullptr;  // more modules in range than we keep: the rest is nobody we dock with
}

bool DockingService::near() const {
  return following_ || is_target_ ||
         (membership_.agreement().active() && membership_.agreement().active()->epoch != 0);
}

bool DockingService::is_fresh(const Module& module, TimePoint now) const {
  return module.heard != TimePoint{} && chain::is_fresh(now - module.heard, near(), freshness);
}

void DockingService::take(TimePoint now) noexcept {
  const auto note = [&](std::uint32_t id, Duration age) -> Module* {
    Module* m = find(id);
    if (m != nullptr) m->heard = std::max(m->heard, now - age);
    return m;
  };
  while (const auto s = module_states_.take()) {
    if (Module* m = note(s->value.module_id, s->age)) {
      m->state = s->value;
      m->state_at = now - s->age;
    }
  }
  while (const auto s = joint_states_.take()) {
    Module* m = note(s->value.module_id, s->age);
    for (std::size_t k = 0; m != nullptr && k < std::min(s->value.joints.size(), airframe_.joints.size()); ++k) {
      m->joint_rad[k] = s->value.joints[k].position_rad;
    }
  }
  while (const auto s = external_wrenches_.take()) {
    Module* m = note(s->value.module_id, s->age);
    if (m == nullptr) continue;
    m->zeroed = s->value.zeroed;
    if (m == &own()) external_W_ = {robot::vector(s->value.force_W_N), robot::vector(s->value.moment_W_Nm)};
  }
  while (const auto s = docking_states_.take()) {
    if (s->value.module_id == config_.module_id) continue;
    if (Module* m = note(s->value.module_id, s->age)) m->docking = s->value;
  }
  take_beacons();
  while (const auto s = heartbeats_.take()) {
    if (s->value.module_id == config_.module_id && s->value.service == "control") {
      own().flying = in_the_air(s->value.flight_mode);
    }
  }
}

void DockingService::take_beacons() noexcept {
  while (const auto s = beacons_.take()) {
    const msg::Beacon& beacon = s->value;
    Module* m = find(beacon.module_id);
    if (m == nullptr || m == &own()) continue;
    m->flying = in_the_air(beacon.flight_mode);
    m->zeroed = m->zeroed || beacon.wrench_zeroed;
    m->heard = std::max(m->heard, last_step_);
  }
}

void DockingService::update_membership(TimePoint now) noexcept {
  BoundedVector<chain::PeerStatus, std::tuple_size_v<decltype(modules_)>> peers;
  for (const Module& m : modules_) {
    if (m.id == 0 || m.id == config_.module_id) continue;
    peers.push_back({.module = m.id, .fresh = is_fresh(m, now), .clock_offset = ring_.clock_offset(m.id)});
  }
  membership_.update(now, {peers.data(), peers.size()});
}

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
}

Candidate DockingService::candidate(const Module* module, std::uint32_t id, TimePoint now) const {
  Candidate c{.module = id};
  if (module == nullptr || module->heard == TimePoint{}) return c;
  const bool own_one = id == config_.module_id;
  const msg::DockingPhase phase = own_one ? state_.phase : module->docking.phase;
  c.known = true;
  c.fresh = own_one || is_fresh(*module, now);
  c.flying = module->flying;
  c.docking = phase != msg::DockingPhase::idle && phase != msg::DockingPhase::docked;
  c.zeroed = module->zeroed || !config_.require_zeroed;
  return c;
}

void DockingService::add_free_ports(std::uint32_t module_id, TimePoint now,
                                    BoundedVector<FreePort, 2 * robot::members_max>& ports) {
  const Module* m = find(module_id);
  if (m == nullptr) return;
  for (std::uint32_t port = 0; port < airframe_.ports.size(); ++port) {
    if (membership_.linked(module_id, port)) continue;
    ports.push_back({.module = module_id,
                     .port = port,
                     .kind = airframe_.ports[port].kind,
                     .X_WP = port_pose_W(*m, port, body_pose_W(*m, now))});
  }
}

void DockingService::dock(const msg::DockGoal& goal, TimePoint now) noexcept {
  const auto refuse = [&](std::string_view reason) {
    answer(goal.correlation_id, msg::GoalPhase::refused, reason, now);
  };
  const std::optional<chain::View>& view = membership_.agreement().active();
  if (view && view->members.size() > 1) {
    refuse("in a chain, which follows nobody: name the other module as follower");
    return;
  }
  BoundedVector<FreePort, 2 * robot::members_max> own_ports, target_ports;
  BoundedVector<std::uint32_t, chain::max_modules> component;
  chain::component_of(goal.target_id, membership_.agreement().graph(), component);
  for (const std::uint32_t member : component) add_free_ports(member, now, target_ports);
  add_free_ports(config_.module_id, now, own_ports);
  const auto choice = choose_ports({own_ports.data(), own_ports.size()}, {target_ports.data(), target_ports.size()},
                                   config_.sequence.standoff_m);
  const bool same_chain = std::find(component.begin(), component.end(), config_.module_id) != component.end();
  const DockAnswer verdict =
      refuse_dock(candidate(&own(), config_.module_id, now), candidate(find(goal.target_id), goal.target_id, now),
                  same_chain, choice.has_value());
  if (verdict.refusal != DockRefusal::none) {
    refuse(verdict.text().view());
    return;
  }
  pairing_ = {choice->target.module, choice->follower.port, choice->target.port};
  membership_.expect(pairing_.port, pairing_.peer, pairing_.peer_port);
  X_WT_ = choice->target.X_WP;
  X_WT_known_ = true;
  push_bias_N_ = 0;
  follower_.start_docking(choice->target.kind, choice->target.X_WP.inverse() * choice->follower.X_WP);
  following_ = goal_pending_ = true;
  goal_id_ = goal.correlation_id;
  answer(goal_id_, msg::GoalPhase::accepted, "", now);
}

void DockingService::undock(const msg::DockGoal& goal, TimePoint now) noexcept {
  for (std::uint32_t port = 0; port < airframe_.ports.size(); ++port) {
    const auto link = membership_.link_of(port);
    if (!link || link->peer != goal.target_id) continue;
    Module* peer = find(goal.target_id);
    if (peer == nullptr) break;
    pairing_ = {goal.target_id, port, link->peer_port};
    X_WT_ = port_pose_W(*peer, pairing_.peer_port, body_pose_W(*peer, now));
    X_WT_known_ = true;
    const robot::Pose X_WF = port_pose_W(own(), port, body_pose_W(own(), now));
    follower_.start_undocking(airframe_.ports[pairing_.peer_port].kind, X_WT_.inverse() * X_WF);
    following_ = goal_pending_ = true;
    goal_id_ = goal.correlation_id;
    answer(goal_id_, msg::GoalPhase::accepted, "", now);
    return;
  }
  answer(goal.correlation_id, msg::GoalPhase::refused, "no link to that module", now);
}

robot::Pose DockingService::body_pose_W(const Module& module, TimePoint now) const {
  // States cross the radio in tens of milliseconds: on with the motion they had.
  const double ahead_s = std::clamp(to_s(now - module.state_at), 0.0, 0.2);
  const robot::Vector3 w = robot::vector(module.state.w_WM_M_rad_s);
  const robot::Matrix3 R = robot::rotation(module.state.q_WM) * robot::exp_so3(w * ahead_s);
  const robot::Vector3 p_WM = robot::vector(module.state.p_WM_m) + robot::vector(module.state.v_WM_m_s) * ahead_s;
  const std::span<const double> joints(module.joint_rad.data(), airframe_.joints.size());
  return {p_WM - R * robot::com_offset_B(airframe_, joints), R};
}

robot::Pose DockingService::port_pose_W(const Module& module, std::uint32_t port, const robot::Pose& X_WB) const {
  const std::span<const double> joints(module.joint_rad.data(), airframe_.joints.size());
  return X_WB * robot::port_pose_B(airframe_, static_cast<int>(port), joints);
}

void DockingService::track_target(TimePoint now, double dt_s) noexcept {
  const Module* peer = find(pairing_.peer);
  const robot::Pose X_WT = port_pose_W(*peer, pairing_.peer_port, body_pose_W(*peer, now));
  const double share = config_.target_filter_s > 0 ? 1 - std::exp(-dt_s / config_.target_filter_s) : 1;
  X_WT_.p += share * (X_WT.p - X_WT_.p);
  X_WT_.R = X_WT_.R * robot::exp_so3(share * robot::log_so3(X_WT_.R.transpose() * X_WT.R));
}

void DockingService::follow(TimePoint now, double dt_s) noexcept {
  Module* peer = find(pairing_.peer);
  const bool fresh = is_fresh(*peer, now);
  if (fresh) track_target(now, dt_s);
  const robot::PortKind target_kind = airframe_.ports[pairing_.peer_port].kind;
  const robot::Pose X_WT = port_pose_W(*peer, pairing_.peer_port, body_pose_W(*peer, now));
  const robot::Pose X_WF = port_pose_W(own(), pairing_.port, body_pose_W(own(), now));
  push_N_ = push_N(external_W_.force, X_WT.R, target_kind);
  if (follower_.outputs().phase == DockingPhase::align || follower_.outputs().phase == DockingPhase::recover) {
    push_bias_N_ += (1 - std::exp(-dt_s / config_.push_bias_s)) * (push_N_ - push_bias_N_);
  }
  push_N_ -= push_bias_N_;

  BoundedVector<robot::Vector3, 32> others_T;
  for (const Module& m : modules_) {
    if (m.id == 0 || m.id == config_.module_id || m.id == pairing_.peer || !is_fresh(m, now)) continue;
    others_T.push_back(X_WT.inverse() * body_pose_W(m, now).p);
  }
  // The peer's latch is not ours to read: its claim on its port says that it has let go.
  const bool peer_holds = membership_.linked(pairing_.peer, pairing_.peer_port);
  const DockingOutputs& out =
      follower_.update(dt_s, {.X_TF = X_WT.inverse() * X_WF,
                              .push_N = push_N_,
                              .latch = membership_.latch(pairing_.port),
                              .target_latch = peer_holds ? chain::LatchStatus::latched : chain::LatchStatus::open,
                              .target_fresh = fresh,
                              .view_active = membership_.active_with(pairing_.peer),
                              .bodies_T = {others_T.data(), others_T.size()}});
  tell_latch(pairing_.port, out.engage_latch, now);
  if (out.phase != DockingPhase::idle && out.phase != DockingPhase::docked && out.phase != DockingPhase::release) {
    write_reference(now);
  }
  if (out.outcome == Outcome::running || out.outcome == Outcome::none) return;
  following_ = false;
  if (!goal_pending_) return;
  goal_pending_ = false;
  const bool done = out.outcome != Outcome::failed;
  answer(goal_id_, done ? msg::GoalPhase::succeeded : msg::GoalPhase::aborted, done ? "" : to_text(out.failure), now);
}

void DockingService::write_reference(TimePoint now) noexcept {
  const DockingOutputs& out = follower_.outputs();
  const std::span<const double> joints(own().joint_rad.data(), airframe_.joints.size());
  const robot::Pose X_WF = X_WT_ * out.X_TF_reference;
  const robot::Pose X_WB = X_WF * robot::port_pose_B(airframe_, static_cast<int>(pairing_.port), joints).inverse();
  msg::DockingReference reference;
  reference.module_id = config_.module_id;
  reference.stamp_ns = to_ns(now);
  reference.p_WM_m = robot::array(X_WB * robot::com_offset_B(airframe_, joints));
  reference.q_WM = robot::quaternion(X_WB.R);
  reference.v_WM_m_s = robot::array(X_WT_.R * out.v_TF_reference);
  docking_reference_.write(reference);
}

void DockingService::be_target(TimePoint now, double dt_s) noexcept {
  if (following_) return;
  if (!is_target_) {
    for (const Module& m : modules_) {
      const msg::DockingState& d = m.docking;
      if (m.id == 0 || d.role != msg::DockingRole::follower || d.peer_id != config_.module_id || !is_fresh(m, now) ||
          d.peer_port >= airframe_.ports.size()) {
        continue;
      }
      // Coming, or asking to be let go while our latch still holds; not on its way out.
      const bool comes = d.phase == msg::DockingPhase::align || d.phase == msg::DockingPhase::approach ||
                         d.phase == msg::DockingPhase::assembly || d.phase == msg::DockingPhase::recover;
      const bool asks_to_go =
          d.phase == msg::DockingPhase::release && membership_.latch(d.peer_port) == chain::LatchStatus::latched;
      if (!comes && !asks_to_go) continue;
      pairing_ = {m.id, d.peer_port, d.port};
      membership_.expect(pairing_.port, pairing_.peer, pairing_.peer_port);
      target_.accept();
      is_target_ = true;
      break;
    }
  }
  if (!is_target_) return;
  const Module* follower = find(pairing_.peer);
  const msg::DockingState& d = follower->docking;
  const bool names_us = d.peer_id == config_.module_id && d.role == msg::DockingRole::follower;
  const TargetOutputs& out =
      target_.update(dt_s, {.follower_fresh = is_fresh(*follower, now),
                            .follower_phase = names_us ? static_cast<DockingPhase>(d.phase) : DockingPhase::idle,
                            .latch = membership_.latch(pairing_.port),
                            .view_active = membership_.active_with(pairing_.peer)});
  tell_latch(pairing_.port, out.engage_latch, now);
  is_target_ = out.phase != DockingPhase::idle;
}

void DockingService::tell_latch(std::uint32_t port, bool engage, TimePoint now) noexcept {
  // Only in a docking of ours: a latch that nobody speaks to stays as it is, through restarts too.
  const bool repeat = now - latch_told_at_[port] > std::chrono::seconds(1);
  if (latch_told_[port] == engage && !repeat) return;
  latch_told_[port] = engage;
  latch_told_at_[port] = now;
  msg::LatchCommand out;
  out.module_id = config_.module_id;
  out.port = port;
  out.stamp_ns = to_ns(now);
  out.engage = engage;
  latch_command_.write(out);
}

void DockingService::write_state(TimePoint now) noexcept {
  msg::DockingState out;
  out.module_id = config_.module_id;
  if (following_ || (!is_target_ && follower_.outputs().phase == DockingPhase::docked)) {
    const DockingOutputs& f = follower_.outputs();
    out.phase = static_cast<msg::DockingPhase>(f.phase);
    out.role = msg::DockingRole::follower;
    out.correlation_id = goal_id_;
    out.declared_by = static_cast<msg::DeclaredBy>(f.declared_by);
    out.recoveries = f.recoveries;
    out.false_declarations = f.false_declarations;
    out.axial_gap_m = f.measured.gap_m;
    out.radial_m = f.measured.radial_m;
    out.attitude_error_rad = f.measured.attitude_rad;
    out.commanded_gap_m = f.gap_m_commanded;
    out.push_N = push_N_;
  } else if (is_target_) {
    const msg::DockingState& f = find(pairing_.peer)->docking;
    out.phase = static_cast<msg::DockingPhase>(target_.outputs().phase);
    out.role = msg::DockingRole::target;
    out.correlation_id = f.correlation_id;
    // As the follower says: our control treats the contact as its own does.
    out.declared_by = f.declared_by;
    out.axial_gap_m = f.axial_gap_m;
    out.commanded_gap_m = f.commanded_gap_m;
  }
  if (out.role != msg::DockingRole::none) {
    out.peer_id = pairing_.peer;
    out.port = pairing_.port;
    out.peer_port = pairing_.peer_port;
  }
  const bool changed = out.phase != state_.phase || out.role != state_.role || out.peer_id != state_.peer_id ||
                       out.declared_by != state_.declared_by || out.recoveries != state_.recoveries;
  const bool active = following_ || is_target_;
  if (out.phase != state_.phase) {
    const auto& names = bus::EnumTraits<msg::DockingPhase>::names;
    msg::Event event{
        .module_id = config_.module_id, .stamp_ns = to_ns(now), .service = "docking", .machine = "docking"};
    event.from = names[static_cast<std::size_t>(state_.phase)];
    event.to = names[static_cast<std::size_t>(out.phase)];
    event_.write(event);
  }
  if (!changed && !(active && now >= state_due_) && !first_step_) return;
  state_due_ = now + from_s(1 / config_.state_rate_Hz);
  out.stamp_ns = to_ns(now);
  state_ = out;
  docking_state_.write(out);
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
