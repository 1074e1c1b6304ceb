// take(); reference; control; allocate; write.
#include "services/control/control_service.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/robot/arrays.hpp"

namespace eciton::control {
namespace {

ContactLaw contact_law(const std::string& name) {
  return name == "none" ? ContactLaw::none : name == "paper" ? ContactLaw::paper : ContactLaw::local;
}

constexpr Duration docking_silence = std::chrono::seconds(1);  // of a chain mate that was docking
constexpr Duration base_reference_interval = std::chrono::milliseconds(50);
constexpr Duration law_silence = std::chrono::milliseconds(300);  // without an estimate: the feed-forward fades

robot::Pose pose_of(const msg::ModuleState& s) { return {robot::vector(s.p_WM_m), robot::rotation(s.q_WM)}; }

}  // namespace

ControlService::ControlService(bus::Participant& ring, const ControlConfig& config, const robot::Airframe& airframe)
    : config_(config),
      airframe_(airframe),
      reference_(airframe, {.speed_m_s = config.speed_m_s, .limits = {}}),
      law_({.law = contact_law(config.law),
            .observer_gain_1_s = config.observer_gain_1_s,
            .bending_rate_1_s = config.local_rate_1_s,
            .paper_period_s = 1 / config.paper_rate_Hz,
            .paper_gain = config.paper_gain,
            .sign = config.law_sign}),
      allocator_(airframe),
      reach_(airframe),
      neighbourhood_(config.module_id),
      faults_(ring, config.module_id, "control", config.recorder, recorded(airframe)),
      module_state_(ring.create_reader(topics::module_state)),
      joint_state_(ring.create_reader(topics::joint_state)),
      rotor_state_(ring.create_reader(topics::rotor_state)),
      external_wrench_(ring.create_reader(topics::external_wrench)),
      contact_wrench_(ring.create_reader(topics::contact_wrench)),
      model_errors_(ring.create_reader(topics::model_errors)),
      chain_view_(ring.create_reader(topics::chain_view)),
      docking_state_(ring.create_reader(topics::docking_state)),
      beacon_(ring.create_reader(topics::beacon)),
      mode_request_(ring.create_reader(topics::mode_request)),
      flight_goal_(ring.create_reader(topics::flight_goal)),
      path_goal_(ring.create_reader(topics::path_goal)),
      morph_goal_(ring.create_reader(topics::morph_goal)),
      contact_goal_(ring.create_reader(topics::contact_goal)),
      docking_reference_(ring.create_reader(topics::docking_reference)),
      base_reference_(ring.create_reader(topics::base_reference)),
      rotor_command_(ring.create_writer(topics::rotor_command)),
      base_reference_out_(ring.create_writer(topics::base_reference)),
      goal_status_(ring.create_writer(topics::goal_status)),
      event_(ring.create_writer(topics::event)) {
  module_state_.news_only_of(config.module_id);  // peers' states come on this topic too and trigger nothing
}

void ControlService::step(TimePoint now) noexcept {
  if (first_step_ && !loaded_) epoch_ = now;
  sent_.reset();
  take_state(now);
  take_surroundings(now);
  take_chain(now);
  take_wrenches(now);
  take_base_reference(now);
  const bool acts = settled(now);
  judge(now);
  take_requests(now);
  take_goals(now);
  if (acts) {
    follow_mode(now);
    if (flying(mode_)) {
      write_rotors(now);
    } else {
      write_idle(now);
    }
  } else if (mode_ == FlightMode::stopped) {
    write_idle(now);
  }
  report_mode(now);
  if (faults_.records()) record(now);
  faults_.tell(now);
  last_step_ = now;
  first_step_ = false;
}

void ControlService::load_state(runtime::StateReader& reader) noexcept {
  visit_state(*this, reader);
  loaded_ = true;
  saved_at_ = last_step_;
  reported_mode_ = mode_;
}

bool ControlService::settled(TimePoint now) noexcept {
  // The first command decides whether rotors that turn go on turning. Until it is known, silence: the hardware host
  // flies the module by itself.
  if (settled_) return true;
  if (!rotors_armed_) return false;
  if (!*rotors_armed_) {
    if (mode_ != FlightMode::stopped) mode_ = FlightMode::disarmed;
    settled_ = true;
    return true;
  }
  // A state of this start, fresh enough to fly by.
  if (state_at_ == TimePoint{}) return false;
  if (!loaded_ || !flying(mode_) || now - saved_at_ > runtime::resume_within) {
    // Nothing to go on from: the hardware host brings it down, and we wait for that.
    if (mode_ != FlightMode::stopped) mode_ = FlightMode::disarmed;
    loaded_ = false;
    if (!gave_up_) {
      faults_.raise(now, msg::Severity::error, "flight",
                    "started in the air with nothing to go on from: silent until the hardware host has landed");
    }
    gave_up_ = true;
    return false;
  }
  settled_ = true;
  return true;
}

void ControlService::take_state(TimePoint now) noexcept {
  while (const auto sample = module_state_.take()) {
    const msg::ModuleState& s = sample->value;
    if (s.module_id == config_.module_id) {
      state_ = s;
      state_at_ = from_ns(s.stamp_ns);
    } else {
      neighbourhood_.hear(s, now - sample->age);
    }
  }
  // States come at the IMU's pace; between them the module goes on as it was going.
  const double ahead_s = std::clamp(to_s(now - state_at_), 0.0, 0.02);
  motion_.v_WM = robot::vector(state_.v_WM_m_s);
  motion_.w_WM_M = robot::vector(state_.w_WM_M_rad_s);
  motion_.p_WM = robot::vector(state_.p_WM_m) + motion_.v_WM * ahead_s;
  motion_.R_WM = robot::rotation(state_.q_WM) * robot::exp_so3(motion_.w_WM_M * ahead_s);
}

void ControlService::take_surroundings(TimePoint now) noexcept {
  while (const auto sample = joint_state_.take()) {
    const msg::JointState& joints = sample->value;
    if (joints.module_id != config_.module_id) {
      neighbourhood_.hear(joints);
      continue;
    }
    for (std::size_t k = 0; k < airframe_.joints.size() && k < joints.joints.size(); ++k) {
      joint_rad_[k] = joints.joints[k].position_rad;
    }
    joint_state_at_ = now - sample->age;
  }
  while (const auto sample = rotor_state_.take()) {
    if (sample->value.module_id != config_.module_id) continue;
    rotors_armed_ = sample->value.armed;
    rotor_state_at_ = now - sample->age;
  }
  while (const auto sample = docking_state_.take()) {
    neighbourhood_.hear(sample->value, now - sample->age);
    if (sample->value.module_id == config_.module_id) docking_ = sample->value;
  }
  while (const auto sample = beacon_.take()) {
    neighbourhood_.hear(sample->value);
    if (sample->value.module_id == config_.module_id) duplicate_id_ = sample->value.duplicate_id;
  }
}

bool ControlService::is_member(std::uint32_t module_id) const {
  return std::find(view_.members.begin(), view_.members.end(), module_id) != view_.members.end();
}

bool ControlService::is_docking(const msg::DockingState& state) {
  return state.phase != msg::DockingPhase::idle && state.phase != msg::DockingPhase::docked;
}

const msg::DockingState& ControlService::docking_now() const {
  if (!in_chain() || is_docking(docking_)) return docking_;
  for (const Peer& p : neighbourhood_.peers()) {
    // While it docks it says so many times a second; a member that fell silent ties nobody down.
    if (is_docking(p.docking) && last_step_ - p.docking_at < docking_silence && is_member(p.module_id))
      return p.docking;
  }
  return docking_;
}

void ControlService::take_chain(TimePoint now) noexcept {
  while (const auto sample = chain_view_.take()) {
    const msg::ChainView& view = sample->value;
    neighbourhood_.hear(view);
    if (view.module_id != config_.module_id || !view.active || view.active_epoch == view_.active_epoch) continue;
    const double now_s = seconds(now);
    law_.reset();
    common_W_ = {};
    hand_over_.begin();
    if (separation_.gives_way()) reference_.hold({flown_.p_WM, flown_.R_WM});
    separation_.reset();
    if (view.members.size() > 1) {
      enter_chain(view, now);
    } else if (in_chain()) {
      reference_.leave(now_s);
    }
    view_ = view;
  }
}

void ControlService::enter_chain(const msg::ChainView& view, TimePoint now) noexcept {
  const std::size_t joints_each = airframe_.joints.size();
  std::array<double, robot::coordinates_max> joint_rad{};
  ChainPlace place{.members = view.members.size(), .own = 0, .base = 0};
  robot::Pose X_WM_base = pose_of(state_);
  for (std::size_t i = 0; i < view.members.size(); ++i) {
    const std::uint32_t id = view.members[i];
    const std::span own_part = std::span(joint_rad).subspan(i * joints_each, joints_each);
    const Peer* other = id == config_.module_id ? nullptr : neighbourhood_.find(id);
    for (std::size_t k = 0; k < joints_each; ++k) {
      if (id == config_.module_id) own_part[k] = joint_rad_[k];
      if (other != nullptr && k < other->joints.joints.size()) own_part[k] = other->joints.joints[k].position_rad;
    }
    if (id == config_.module_id) place.own = i;
    if (id != view.base_id) continue;
    place.base = i;
    if (other != nullptr && other->state.module_id == id) X_WM_base = pose_of(other->state);
  }
  reference_.join(place, std::span<const double>(joint_rad).first(place.members * joints_each), X_WM_base,
                  seconds(now));
}

void ControlService::see_base(TimePoint now) noexcept {
  if (!in_chain() || base_.epoch != view_.active_epoch || !base_.at_rest) return;
  reference_.see_base({robot::vector(base_.p_WM_m), robot::rotation(base_.q_WM)}, seconds(now));
}

void ControlService::take_base_reference(TimePoint now) noexcept {
  while (const auto sample = base_reference_.take()) {
    const msg::BaseReference& base = sample->value;
    if (!in_chain() || base.epoch != view_.active_epoch || base.module_id != view_.base_id || integrates()) continue;
    const robot::Vector3 linear_m_s2 = robot::vector(base.integral_W_m_s2);
    const robot::Vector3 angular_rad_s2 = robot::vector(base.integral_M_rad_s2);
    if (!is_pose(base.p_WM_m, base.q_WM)) {
      ++rejected_;
      continue;
    }
    if (base_.epoch == base.epoch) {
      follow_integrals(linear_m_s2 - robot::vector(base_.integral_W_m_s2),
                       robot::rotation(base.q_WM) * (angular_rad_s2 - robot::vector(base_.integral_M_rad_s2)),
                       seconds(now));
    }
    base_ = base;
  }
}

/// Ours differ from the base's by what each module had before it joined, and follow their changes as a rigid body.
void ControlService::follow_integrals(const robot::Vector3& linear_W_m_s2, const robot::Vector3& angular_W_rad_s2,
                                      double now_s) noexcept {
  std::array<robot::PoseReference, robot::members_max> members;
  reference_.members_at(now_s, members);
  const robot::Vector3 lever_W_m = members[reference_.place().own].p_WM - members[reference_.place().base].p_WM;
  pose_control_.set_integrals(pose_control_.integral_m_s2() + linear_W_m_s2 + angular_W_rad_s2.cross(lever_W_m),
                              pose_control_.integral_rad_s2() + motion_.R_WM.transpose() * angular_W_rad_s2);
}

void ControlService::take_model_errors() noexcept {
  while (const auto sample = model_errors_.take()) {
    const msg::ModelErrors& m = sample->value;
    if (m.module_id != config_.module_id || !config_.model_correction) continue;
    errors_.setZero();
    for (std::size_t k = 0; k < m.thrust_share.size(); ++k) errors_[static_cast<Eigen::Index>(k)] = m.thrust_share[k];
    errors_[robot::error_mass] = m.mass_share;
    errors_.segment<3>(robot::error_com) = robot::vector(m.com_B_m);
    errors_.segment<3>(robot::error_attitude) = robot::vector(m.attitude_rad);
    hand_over_.begin();  // the integrals held against it until now
  }
}

void ControlService::take_wrenches(TimePoint now) noexcept {
  take_model_errors();
  while (const auto sample = external_wrench_.take()) {
    const msg::ExternalWrench& w = sample->value;
    if (w.module_id != config_.module_id) continue;
    external_W_ = {robot::vector(w.force_W_N), robot::vector(w.moment_W_Nm)};
  }
  while (const auto sample = contact_wrench_.take()) {
    const msg::ContactWrench& w = sample->value;
    if (w.module_id == config_.module_id) contact_wrench_at_ = now - sample->age;
    if (w.module_id == config_.module_id && in_chain() && w.epoch == view_.active_epoch) take_contact_wrench(w, now);
  }
  if (in_chain() && now - law_updated_ > law_silence) {
    law_.fade(to_s(now - last_step_));
    common_W_ = {};
  }
}

void ControlService::take_contact_wrench(const msg::ContactWrench& w, TimePoint now) noexcept {
  std::array<ChainMember, robot::members_max> members;
  std::size_t own = 0;
  for (std::size_t k = 0; k < w.members.size(); ++k) {
    const msg::MemberWrench& m = w.members[k];
    if (m.module_id == config_.module_id) own = k;
    members[k] = {.d_W = {robot::vector(m.d_force_W_N), robot::vector(m.d_moment_W_Nm)},
                  .contact_W = {robot::vector(m.link_force_W_N), robot::vector(m.link_moment_W_Nm)},
                  .r_W = robot::vector(m.r_W_m),
                  .link_W = robot::vector(m.link_W_m),
                  .age_s = m.age_s};
  }
  // What is left of our external wrench without the contact.
  const double heard = static_cast<double>(w.fresh) / static_cast<double>(w.members.size());
  common_W_ = (external_W_ - members[own].d_W) * heard;
  const double dt_s = std::clamp(to_s(now - law_updated_), 0.0, 0.1);
  law_updated_ = now;
  std::array<robot::Wrench, robot::members_max> desired_W;
  law_.update(std::span<const ChainMember>(members).first(w.members.size()), own, desired_contacts(desired_W, now),
              dt_s);
}

std::span<const robot::Wrench> ControlService::desired_contacts(std::span<robot::Wrench> room,
                                                                TimePoint now) const noexcept {
  const msg::ContactGoal& goal = contact_goal_now_;
  if (goal.links.empty() || goal.epoch != view_.active_epoch) return {};
  std::array<robot::PoseReference, robot::members_max> members;
  reference_.members_at(seconds(now), members);
  for (std::size_t k = 0; k < goal.links.size(); ++k) {
    const robot::Matrix3& R_WM = members[k].R_WM;
    room[k] = {R_WM * robot::vector(goal.links[k].force_M_N), R_WM * robot::vector(goal.links[k].moment_M_Nm)};
  }
  return room.first(goal.links.size());
}

void ControlService::judge(TimePoint now) noexcept {
  const double dt_s = first_step_ ? 0 : to_s(now - last_step_);
  const FlightModeConfig limits;
  conditions_.state_ready = state_.mode == msg::EstimatorMode::ready;
  conditions_.state_usable = conditions_.state_ready || state_.mode == msg::EstimatorMode::dead_reckoning;
  conditions_.state_age_s = to_s(now - state_at_);
  const bool good = conditions_.state_usable && conditions_.state_age_s <= limits.state_age_s_max;
  conditions_.state_good_s = good ? conditions_.state_good_s + dt_s : 0;
  conditions_.trajectory_finished = goal_pending_ && reference_.arrived(seconds(now)) && !separation_.gives_way();
  conditions_.landed =
      mode_ == FlightMode::land && touchdown_.update(allocation_.achieved_B.force.norm(),
                                                     airframe_.mass_kg * robot::gravity_m_s2, motion_.v_WM.z(), dt_s);
  conditions_.duplicate_id = duplicate_id_;
  conditions_.rotors_known = settled_;
}

void ControlService::follow_mode(TimePoint now) noexcept {
  const FlightMode before = mode_;
  const FlightDecision decision = advance(before, conditions_);
  mode_ = decision.mode;
  if (before != mode_ && mode_ == FlightMode::failsafe) {
    faults_.raise(now, msg::Severity::error, "flight",
                  conditions_.state_usable ? "module state too old: silent, the hardware host flies it down"
                                           : "estimation lost: silent, the hardware host flies it down");
  }
  if (before == FlightMode::armed && mode_ == FlightMode::disarmed) {
    faults_.raise(now, msg::Severity::warning, "flight", decision.reason);
  }
  if (before == FlightMode::failsafe && mode_ == FlightMode::hover) {
    // Apart it stays where it drifted to; a member of a chain goes back to its place in it.
    if (!in_chain()) reference_.hold({motion_.p_WM, robot::upright(motion_.R_WM)});
    separation_.reset();
    pose_control_.reset();
  }
  const bool done = goal_pending_ && (conditions_.trajectory_finished || conditions_.landed);
  if (!done) return;
  goal_pending_ = false;
  if (goal_is_ours_) answer(msg::GoalKind::flight, goal_id_, msg::GoalPhase::succeeded, "", now);
}

robot::PoseReference ControlService::separated(TimePoint now, double dt_s) noexcept {
  const robot::PoseReference nominal = reference_.at(seconds(now));
  if (in_chain() || !config_.separation) return nominal;
  const SeparationConfig& keep = separation_.config();
  Fence fence{robot::vector(config_.fence_low_m), robot::vector(config_.fence_high_m)};
  // From and to the ground it goes whatever the ground's height is.
  if (mode_ == FlightMode::takeoff || mode_ == FlightMode::land) fence.low_W.z() = -1e9;
  return separation_.update({.nominal = nominal,
                             .p_WM_ahead = reference_.at(seconds(now) + keep.look_ahead_s).p_WM,
                             .p_WM = motion_.p_WM,
                             .neighbours = neighbourhood_.keep_clear_of(motion_.p_WM, keep.distance_m, now),
                             .fence = fence},
                            dt_s);
}

void ControlService::write_rotors(TimePoint now) noexcept {
  // With the state lost there is nothing to control by: silence hands over to the hardware host, which flies
  // the module down on the IMU.
  if (mode_ == FlightMode::failsafe) return;
  const double dt_s = first_step_ ? config_.period_s : std::clamp(to_s(now - last_step_), 1e-4, 0.02);
  const robot::Vector3 c_B = robot::com_offset_B(airframe_, joint_angles());
  // A chain that docks, or is docked to, must hit a port as a module does: as stiff.
  const bool gentle = in_chain() && !is_docking(docking_now());
  pose_control_.set_gains(
      between(gains_assembled(), gains_free(), gentle ? config_.stiffness : config_.stiffness_alone));
  const robot::Wrench feed_forward_W = hand_over_.update(feed_forward(dt_s) + correction(c_B), dt_s);
  const robot::PoseReference before = std::exchange(flown_, separated(now, dt_s));
  if (in_chain()) law_.turn(flown_.R_WM * before.R_WM.transpose());
  const robot::Wrench demanded_B =
      pose_control_.update({.state = motion_,
                            .reference = flown_,
                            .mass_kg = airframe_.mass_kg,
                            .I_M_kg_m2 = robot::composite_inertia(airframe_, joint_angles()),
                            .feed_forward_W = feed_forward_W,
                            .integrate = integrates(),
                            .force_saturated = allocation_.force_scale < 1 || allocation_.thrust_limited,
                            .moment_saturated = allocation_.moment_scale < 1},
                           dt_s);
  allocation_ = allocator_.update(demanded_B, c_B);

  msg::RotorCommand out;
  out.module_id = config_.module_id;
  out.stamp_ns = to_ns(now);
  out.state_stamp_ns = state_.stamp_ns;
  out.armed = true;
  out.safe_output = in_chain() ? msg::SafeOutput::hold_hover : msg::SafeOutput::descend;
  for (const robot::RotorOutput& rotor : allocation_.outputs())
    out.rotors.push_back({rotor.thrust_N, rotor.gimbal_rad});
  rotor_command_.write(out);
  sent_ = out;
  if (is_base() && now - base_written_at_ >= base_reference_interval) write_base_reference(now);
}

void ControlService::write_base_reference(TimePoint now) noexcept {
  const robot::PoseReference at = reference_.at(seconds(now));
  base_reference_out_.write({.module_id = config_.module_id,
                             .stamp_ns = to_ns(now),
                             .epoch = view_.active_epoch,
                             .at_rest = reference_.at_rest(seconds(now)),
                             .p_WM_m = robot::array(at.p_WM),
                             .q_WM = robot::quaternion(at.R_WM),
                             .integral_W_m_s2 = robot::array(pose_control_.integral_m_s2()),
                             .integral_M_rad_s2 = robot::array(pose_control_.integral_rad_s2())});
  base_written_at_ = now;
}

/// Against the false wrench that the rotors make as they are now.
robot::Wrench ControlService::correction(const robot::Vector3& c_B) const noexcept {
  const robot::BiasJacobian jacobian_M = robot::bias_jacobian(airframe_, allocation_.outputs(), c_B, motion_.R_WM);
  return -robot::rotate(motion_.R_WM, robot::false_wrench_M(jacobian_M, errors_));
}

robot::Wrench ControlService::feed_forward(double dt_s) noexcept {
  if (!config_.disturbance_feedback) return in_chain() ? law_.feed_forward_W() : robot::Wrench{};
  const msg::DockingState& docking = docking_now();
  const auto phase_of = [&](bool docks) {
    return feedback_phase(docks, docking.commanded_gap_m, docking.declared_by != msg::DeclaredBy::nothing);
  };
  if (!in_chain()) {
    // Alone the attitude's own integral copes with moments.
    const robot::Wrench force_W{external_W_.force, robot::Vector3::Zero()};
    return feedback_.update(force_W, phase_of(docking.phase != msg::DockingPhase::idle), dt_s);
  }
  // In a chain only what acts on all alike is a disturbance; the rest is contact, and the law's. What a target
  // pushes back with acts on all alike too: close to it the feedback freezes, as apart.
  const FeedbackPhase phase = is_docking(docking) ? phase_of(true) : FeedbackPhase::follow;
  return law_.feed_forward_W() + feedback_.update(common_W_, phase, dt_s);
}

void ControlService::write_idle(TimePoint now) noexcept {
  msg::RotorCommand out;
  out.module_id = config_.module_id;
  out.stamp_ns = to_ns(now);
  out.state_stamp_ns = state_.stamp_ns;
  out.armed = mode_ == FlightMode::armed;
  out.safe_output = msg::SafeOutput::motors_off;
  for (const robot::RotorGeometry& rotor : airframe_.rotors) {
    out.rotors.push_back({out.armed ? rotor.thrust_N_min : 0, {}});
  }
  rotor_command_.write(out);
  sent_ = out;
  pose_control_.reset();
  hand_over_.reset();
}

void ControlService::report_mode(TimePoint now) noexcept {
  if (mode_ == reported_mode_) return;
  const auto text = [](FlightMode mode) {
    return bus::EnumTraits<msg::FlightMode>::names[static_cast<std::size_t>(mode)];
  };
  msg::Event out{.module_id = config_.module_id, .stamp_ns = to_ns(now), .service = "control", .machine = "flight"};
  out.from = text(reported_mode_);
  out.to = text(mode_);
  event_.write(out);
  reported_mode_ = mode_;
}

}  // namespace eciton::control
