// take(); sequence; write.
#include "services/docking/docking_service.hpp"

#include <algorithm>
#include <cmath>

#include "core/robot/arrays.hpp"

namespace eciton::docking {
namespace {

constexpr Duration chain_force_age_max = std::chrono::milliseconds(200);
constexpr double trim_m_max = 0.06;
constexpr double trim_miss_m_max = 0.1;  // more is a gust, or the way there

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
      heard_(ring, config.module_id, airframe),
      radio_watch_(config.module_id, "docking", from_s(1 / config.rate_Hz)),
      dock_goal_(ring.create_reader(topics::dock_goal)),
      contact_wrench_(ring.create_reader(topics::contact_wrench)),
      docking_reference_(ring.create_writer(topics::docking_reference)),
      latch_command_(ring.create_writer(topics::latch_command)),
      docking_state_(ring.create_writer(topics::docking_state)),
      goal_status_(ring.create_writer(topics::goal_status)),
      event_(ring.create_writer(topics::event)),
      fault_(ring.create_writer(topics::fault)) {}

void DockingService::step(TimePoint now) noexcept {
  const double dt_s = first_step_ ? 0 : std::clamp(to_s(now - last_step_), 0.0, 0.1);
  if (first_step_) end_interrupted(now);
  heard_.take(now);
  if (config_.watches) watch_radio(now);
  update_membership(now);
  update_base(now, dt_s);
  take_goals(now);
  if (following_) follow(now, dt_s);
  be_target(now, dt_s);
  watch_handed_on(now);
  write_state(now);
  last_step_ = now;
  first_step_ = false;
}

void DockingService::watch_radio(TimePoint now) noexcept {
  radio_watch_.begin(now);
  if (heard_.radio_beat()) radio_watch_.hear(*heard_.radio_beat());
  radio_watch_.tell(fault_);
}

const chain::View* DockingService::chain() const {
  const std::optional<chain::View>& view = membership_.agreement().active();
  return view && view->members.size() > 1 ? &*view : nullptr;
}

void DockingService::update_membership(TimePoint now) noexcept {
  BoundedVector<chain::PeerStatus, HeardModules::bound> peers;
  for (const HeardModule& m : heard_.all()) {
    if (m.id == 0 || m.id == config_.module_id) continue;
    peers.push_back({.module = m.id, .fresh = is_fresh(m, now), .clock_offset = ring_.clock_offset(m.id)});
  }
  membership_.update(now, {peers.data(), peers.size()});
}

void DockingService::update_base(TimePoint now, double dt_s) noexcept {
  const chain::View* view = chain();
  const std::uint64_t epoch = view == nullptr ? 0 : view->epoch;
  const bool anew = epoch != base_epoch_;
  base_epoch_ = epoch;
  while (const auto sample = contact_wrench_.take()) {
    const msg::ContactWrench& w = sample->value;
    if (w.module_id != config_.module_id || w.epoch != epoch) continue;
    // Gusts and noise on n members sum up to sqrt(n) times those of one: judged as if they were one's.
    chain_force_W_ = std::sqrt(static_cast<double>(w.members.size())) * robot::vector(w.common_force_W_N);
    chain_force_at_ = now - sample->age;
  }
  const HeardModule* base = view == nullptr ? nullptr : heard_.find(view->base);
  if (base == nullptr) return;
  const robot::Pose X_MB = heard_.centre_pose_W(heard_.own(), now).inverse() * heard_.centre_pose_W(*base, now);
  if (anew) {
    X_MB_.start(X_MB);
  } else if (is_fresh(*base, now)) {
    X_MB_.update(dt_s, config_.base_filter_s, X_MB);
  }
}

void DockingService::trim(const robot::Pose& X_WF, double dt_s) noexcept {
  // Every member flies by its own lights: what the docking member's say and what the others' say differ by their
  // sensors' drift, and it ends up between. Standing in front of the port, that is seen and taken off.
  const DockingOutputs& out = follower_.outputs();
  const robot::Vector3 miss_W = X_WT_.pose() * out.X_TF_reference.p - X_WF.p;
  const bool stands = out.phase == DockingPhase::align && out.v_TF_reference.norm() < 0.02;
  if (chain() == nullptr || !stands || miss_W.norm() > trim_miss_m_max) return;
  trim_W_ += dt_s / config_.trim_s * miss_W;
  if (trim_W_.norm() > trim_m_max) trim_W_ *= trim_m_max / trim_W_.norm();
}

void DockingService::measure_push(const robot::Matrix3& R_WT, double dt_s) noexcept {
  // A member of a chain feels its mates too: what is left on all of them together is the target's push.
  const bool of_chain = chain() != nullptr && last_step_ - chain_force_at_ < chain_force_age_max;
  const robot::Vector3& force_W = of_chain ? chain_force_W_ : heard_.own().external_force_W;
  push_N_ = push_N(force_W, R_WT, airframe_.ports[pairing_.peer_port].kind);
  const DockingPhase phase = follower_.outputs().phase;
  if (phase == DockingPhase::align || phase == DockingPhase::recover) {
    push_bias_N_ += (1 - std::exp(-dt_s / config_.push_bias_s)) * (push_N_ - push_bias_N_);
  }
  push_N_ -= push_bias_N_;
}

void DockingService::follow(TimePoint now, double dt_s) noexcept {
  const HeardModule& peer = *heard_.find(pairing_.peer);
  const bool fresh = is_fresh(peer, now);
  const robot::Pose X_WT = heard_.port_pose_W(peer, pairing_.peer_port, now);
  const robot::Pose X_WF = heard_.port_pose_W(heard_.own(), pairing_.port, now);
  if (fresh) X_WT_.update(dt_s, config_.target_filter_s, X_WT);
  trim(X_WF, dt_s);
  measure_push(X_WT.R, dt_s);

  BoundedVector<robot::Vector3, ApproachPath::bodies_max> others_T;
  for (const HeardModule& m : heard_.all()) {
    const bool ours = m.id == config_.module_id || is_member(m.id);
    if (m.id == 0 || ours || m.id == pairing_.peer || !is_fresh(m, now)) continue;
    others_T.push_back(X_WT.inverse() * heard_.body_pose_W(m, now).p);
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
  const robot::Matrix3& R_WT = X_WT_.pose().R;
  const MovingPose port{X_WT_.pose() * out.X_TF_reference, R_WT * out.v_TF_reference, R_WT * out.w_TF_reference};
  MovingPose led = carried_along(port, heard_.centre_from_port(heard_.own(), pairing_.port));
  led.X_WM.p += trim_W_;
  if (chain() != nullptr) led = carried_along(led, X_MB_.pose());
  msg::DockingReference reference;
  reference.module_id = config_.module_id;
  reference.stamp_ns = to_ns(now);
  reference.epoch = base_epoch_;
  reference.p_WM_m = robot::array(led.X_WM.p);
  reference.q_WM = robot::quaternion(led.X_WM.R);
  reference.v_WM_m_s = robot::array(led.v_WM);
  reference.w_WM_M_rad_s = robot::array(led.X_WM.R.transpose() * led.w_WM);
  docking_reference_.write(reference);
}

void DockingService::accept_follower(TimePoint now) noexcept {
  for (const HeardModule& m : heard_.all()) {
    const msg::DockingState& d = m.docking;
    if (m.id == 0 || d.role != msg::DockingRole::follower || d.peer_id != config_.module_id || !is_fresh(m, now) ||
        d.peer_port >= airframe_.ports.size()) {
      continue;
    }
    if (is_target_ && m.id == pairing_.peer) continue;  // its docking is done here, if not yet there
    // Coming, or asking to be let go while our latch still holds; not on its way out.
    const bool comes = d.phase == msg::DockingPhase::align || d.phase == msg::DockingPhase::approach ||
                       d.phase == msg::DockingPhase::assembly || d.phase == msg::DockingPhase::recover;
    const bool asks_to_go =
        d.phase == msg::DockingPhase::release && membership_.latch(d.peer_port) == chain::LatchStatus::latched;
    if (!comes && !asks_to_go) continue;
    pairing_ = {m.id, d.peer_port, d.port};
    membership_.expect(pairing_.port, pairing_.peer, pairing_.peer_port);
    role_ = msg::DockingRole::target;
    target_.accept();
    is_target_ = true;
    return;
  }
}

void DockingService::be_target(TimePoint now, double dt_s) noexcept {
  if (following_) return;
  if (!under_way()) accept_follower(now);
  if (!is_target_) return;
  const HeardModule& follower = *heard_.find(pairing_.peer);
  const msg::DockingState& d = follower.docking;
  const bool names_us = d.peer_id == config_.module_id && d.role == msg::DockingRole::follower;
  const TargetOutputs& out =
      target_.update(dt_s, {.follower_fresh = is_fresh(follower, now),
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

msg::DockingState DockingService::state_message() const noexcept {
  msg::DockingState out;
  out.module_id = config_.module_id;
  Pairing pairing = pairing_;
  if (handed_on_.goal_id != 0 && !under_way()) {
    out.correlation_id = handed_on_.goal_id;
    pairing = handed_on_.pairing;
  } else if (role_ == msg::DockingRole::follower &&
             (following_ || follower_.outputs().phase == DockingPhase::docked)) {
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
    const msg::DockingState& f = heard_.find(pairing_.peer)->docking;
    out.phase = static_cast<msg::DockingPhase>(target_.outputs().phase);
    out.role = msg::DockingRole::target;
    out.correlation_id = f.correlation_id;
    // As the follower says: our control treats the contact as its own does.
    out.declared_by = f.declared_by;
    out.axial_gap_m = f.axial_gap_m;
    out.commanded_gap_m = f.commanded_gap_m;
  }
  if (out.role != msg::DockingRole::none || out.correlation_id != 0) {
    out.peer_id = pairing.peer;
    out.port = pairing.port;
    out.peer_port = pairing.peer_port;
  }
  return out;
}

void DockingService::write_state(TimePoint now) noexcept {
  msg::DockingState out = state_message();
  const bool changed = out.phase != state_.phase || out.role != state_.role || out.peer_id != state_.peer_id ||
                       out.declared_by != state_.declared_by || out.recoveries != state_.recoveries ||
                       out.correlation_id != state_.correlation_id;
  if (out.phase != state_.phase) {
    const auto& names = bus::EnumTraits<msg::DockingPhase>::names;
    msg::Event event{
        .module_id = config_.module_id, .stamp_ns = to_ns(now), .service = "docking", .machine = "docking"};
    event.from = names[static_cast<std::size_t>(state_.phase)];
    event.to = names[static_cast<std::size_t>(out.phase)];
    event_.write(event);
  }
  if (!changed && !((following_ || is_target_) && now >= state_due_) && !first_step_) return;
  state_due_ = now + from_s(1 / config_.state_rate_Hz);
  out.stamp_ns = to_ns(now);
  state_ = out;
  docking_state_.write(out);
}

}  // namespace eciton::docking
