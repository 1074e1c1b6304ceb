// take(); estimate; publish.
#include "services/estimation/estimation_service.hpp"

#include <algorithm>

#include "core/robot/arrays.hpp"

namespace eciton::estimation {
namespace {

constexpr double thrust_share_flying = 0.7;  // of the weight; less: on the floor, or falling

msg::EstimatorMode to_message(FilterMode mode) { return static_cast<msg::EstimatorMode>(mode); }

}  // namespace

EstimationService::EstimationService(bus::Participant& ring, const EstimationConfig& config,
                                     const robot::Airframe& airframe)
    : config_(config),
      airframe_(airframe),
      wrench_period_(from_s(1 / config.wrench_rate_Hz)),
      observer_({.force_gain_1_s = config.observer_gain_1_s, .moment_gain_1_s = config.observer_gain_1_s}),
      rotors_(airframe),
      imu_(ring.create_reader(topics::imu)),
      pose_(ring.create_reader(topics::pose_measurement)),
      rotor_commands_(ring.create_reader(topics::rotor_command)),
      joint_state_(ring.create_reader(topics::joint_state)),
      chain_view_(ring.create_reader(topics::chain_view)),
      docking_state_(ring.create_reader(topics::docking_state)),
      external_wrenches_(ring.create_reader(topics::external_wrench)),
      mode_request_(ring.create_reader(topics::mode_request)),
      module_state_(ring.create_writer(topics::module_state)),
      external_wrench_(ring.create_writer(topics::external_wrench)),
      contact_wrench_(ring.create_writer(topics::contact_wrench)),
      event_(ring.create_writer(topics::event)) {}

void EstimationService::load_state(runtime::StateReader& reader) noexcept { reader(saved_at_, zeroing_); }

void EstimationService::step(TimePoint now) noexcept {
  if (first_step_ && now - saved_at_ > runtime::resume_within) zeroing_ = Zeroing();
  take_chain(now);
  take_actuators();
  take_sensors();
  observe(now);
  publish_state(now);
  if (now >= wrench_due_) {
    publish_external_wrench(now);
    publish_contact_wrench(now);
    wrench_due_ = std::max(wrench_due_ + wrench_period_, now);
  }
  report_mode(now);
  last_step_ = now;
  first_step_ = false;
}

void EstimationService::take_sensors() noexcept {
  while (const auto imu = imu_.take()) {
    if (imu->value.module_id != config_.module_id) continue;
    filter_.update(ImuSample{imu->value.stamp_ns, robot::vector(imu->value.specific_force_M_m_s2),
                             robot::vector(imu->value.w_WM_M_rad_s)});
  }
  while (const auto pose = pose_.take()) {
    const msg::PoseMeasurement& m = pose->value;
    if (m.module_id != config_.module_id) continue;
    const std::uint64_t restarts = filter_.counters().restarts;
    filter_.update(PoseMeasurement{
        m.stamp_ns, {robot::vector(m.p_WB_m), robot::rotation(m.q_WB)}, m.position_std_m, m.attitude_std_rad});
    if (filter_.counters().restarts != restarts) observer_.hold();
  }
  estimate_ = filter_.estimate();
}

void EstimationService::take_actuators() noexcept {
  while (const auto command = rotor_commands_.take()) {
    if (command->value.module_id != config_.module_id) continue;
    armed_ = command->value.armed;
    for (std::size_t k = 0; k < airframe_.rotors.size() && k < command->value.rotors.size(); ++k) {
      const msg::Rotor& rotor = command->value.rotors[k];
      rotor_command_[k] = {armed_ ? rotor.thrust_N : 0, rotor.gimbal_rad};
    }
  }
  while (const auto joints = joint_state_.take()) {
    if (joints->value.module_id != config_.module_id) continue;
    for (std::size_t k = 0; k < airframe_.joints.size() && k < joints->value.joints.size(); ++k) {
      joint_rad_[k] = joints->value.joints[k].position_rad;
    }
  }
}

void EstimationService::take_chain(TimePoint now) noexcept {
  while (const auto view = chain_view_.take()) {
    if (view->value.module_id == config_.module_id) view_ = view->value;
  }
  while (const auto state = docking_state_.take()) {
    const msg::DockingState& s = state->value;
    if (s.module_id != config_.module_id) continue;
    // From the last centimetres on the peer may touch: what is measured then is contact, not bias.
    touching_ = s.phase == msg::DockingPhase::assembly || s.phase == msg::DockingPhase::release ||
                (s.phase == msg::DockingPhase::approach && s.commanded_gap_m < 0.15);
  }
  while (const auto wrench = external_wrenches_.take()) {
    if (wrench->value.module_id == config_.module_id) continue;
    for (std::size_t k = 0; k < view_.members.size(); ++k) {
      if (view_.members[k] != wrench->value.module_id) continue;
      heard_[k] = wrench->value;
      heard_at_[k] = now - wrench->age;
    }
  }
  while (const auto request = mode_request_.take()) {
    if (request->value.module_id == config_.module_id && request->value.action == msg::ModeAction::zero) {
      zero_asked_ = true;
    }
  }
}

void EstimationService::observe(TimePoint now) noexcept {
  const double dt_s = first_step_ ? 0.002 : std::clamp(to_s(now - last_step_), 1e-4, 0.02);
  rotors_.update(std::span(rotor_command_).first(airframe_.rotors.size()), dt_s);
  const std::span<const double> joints = joint_angles();
  const robot::Vector3 c_B = robot::com_offset_B(airframe_, joints);
  const robot::Matrix3& R = estimate_.X_WB.R;
  state_ = {estimate_.X_WB * c_B, estimate_.v_WB + R * estimate_.w_WB_B.cross(c_B)};
  if (estimate_.mode == FilterMode::initialising || estimate_.mode == FilterMode::lost) {
    observer_.hold();
    return;
  }
  observer_.update({.mass_kg = airframe_.mass_kg,
                    .I_M_kg_m2 = robot::composite_inertia(airframe_, joints),
                    .v_WM = state_.v_WM,
                    .w_WM_M = estimate_.w_WB_B,
                    .R_WM = R,
                    .known_M = rotors_.wrench_B(c_B)},
                   dt_s);
  zero(dt_s);
  external_W_ = config_.zeroing ? zeroing_.bias().take_off(observer_.wrench_W(), R) : observer_.wrench_W();
}

void EstimationService::zero(double dt_s) noexcept {
  // By itself, in the first free hover; asked for again, anew. What a peer's touch interrupts begins again.
  if (!free_flight()) {
    zeroing_interrupted_ = true;
    return;
  }
  const bool wanted = zero_asked_ || !zeroing_.zeroed();
  const bool measuring = zeroing_.phase() == ZeroingPhase::measuring;
  if (wanted && (!measuring || zeroing_interrupted_)) zeroing_.start();
  zero_asked_ = zeroing_interrupted_ = false;
  zeroing_.update(observer_.wrench_W(), estimate_.X_WB.R, state_.v_WM, estimate_.w_WB_B, dt_s);
}

bool EstimationService::free_flight() const {
  double thrust_N = 0;
  for (const robot::RotorOutput& rotor : rotors_.rotors()) thrust_N += rotor.thrust_N;
  return armed_ && thrust_N > thrust_share_flying * airframe_.mass_kg * robot::gravity_m_s2 && !touching_ &&
         view_.members.size() <= 1 && view_.epoch == 0;
}

void EstimationService::publish_state(TimePoint now) noexcept {
  msg::ModuleState out;
  out.module_id = config_.module_id;
  out.stamp_ns = to_ns(now);
  out.mode = to_message(estimate_.mode);
  out.p_WM_m = robot::array(state_.p_WM);
  out.q_WM = robot::quaternion(estimate_.X_WB.R);
  out.v_WM_m_s = robot::array(state_.v_WM);
  out.w_WM_M_rad_s = robot::array(estimate_.w_WB_B);
  out.variance = estimate_.variance;
  out.pose_age_s = estimate_.pose_age_s;
  module_state_.write(out);
}

void EstimationService::publish_external_wrench(TimePoint now) noexcept {
  own_ = {};
  own_.module_id = config_.module_id;
  own_.stamp_ns = to_ns(now);
  own_.epoch = view_.active ? view_.active_epoch : 0;
  own_.zeroed = zeroing_.zeroed() || !config_.zeroing;
  own_.zero_quality_N = zeroing_.quality_N();
  own_.force_W_N = robot::array(external_W_.force);
  own_.moment_W_Nm = robot::array(external_W_.moment);
  own_.r_W_m = robot::array(state_.p_WM);
  for (std::size_t port = 0; port < std::min<std::size_t>(airframe_.ports.size(), 4); ++port) {
    const robot::Pose X_BP = robot::port_pose_B(airframe_, static_cast<int>(port), joint_angles());
    const auto p_WP = robot::array(estimate_.X_WB * X_BP.p);
    std::copy(p_WP.begin(), p_WP.end(), own_.port_W_m.begin() + static_cast<std::ptrdiff_t>(3 * port));
  }
  external_wrench_.write(own_);
}

void EstimationService::publish_contact_wrench(TimePoint now) noexcept {
  const std::size_t n = view_.active ? view_.members.size() : 0;
  if (n < 2) return;
  std::array<MemberWrench, robot::members_max> members;
  for (std::size_t k = 0; k < n; ++k) {
    const bool own = view_.members[k] == config_.module_id;
    const msg::ExternalWrench& w = own ? own_ : heard_[k];
    // A wrench of another epoch belongs to a body that is no more, or not yet: it counts as not heard.
    members[k] = {.known = own || (w.module_id == view_.members[k] && w.epoch == view_.active_epoch),
                  .age_s = own ? 0 : to_s(now - heard_at_[k]),
                  .external_W = {robot::vector(w.force_W_N), robot::vector(w.moment_W_Nm)},
                  .r_W = robot::vector(w.r_W_m),
                  .port_to_next_W = {w.port_W_m[0], w.port_W_m[1], w.port_W_m[2]},
                  .port_to_last_W = {w.port_W_m[3], w.port_W_m[4], w.port_W_m[5]}};
  }
  const ContactWrenches contacts = contact_wrenches(std::span<const MemberWrench>(members).first(n));
  if (!contacts.complete) return;
  msg::ContactWrench out;
  out.module_id = config_.module_id;
  out.stamp_ns = to_ns(now);
  out.epoch = view_.active_epoch;
  out.fresh = static_cast<std::uint32_t>(contacts.fresh);
  out.common_force_W_N = robot::array(contacts.common_W.force);
  out.common_moment_W_Nm = robot::array(contacts.common_W.moment);
  for (std::size_t k = 0; k < n; ++k) {
    const MemberContact& contact = contacts.members[k];
    out.members.push_back({.module_id = view_.members[k],
                           .age_s = members[k].age_s,
                           .r_W_m = robot::array(members[k].r_W),
                           .d_force_W_N = robot::array(contact.d_W.force),
                           .d_moment_W_Nm = robot::array(contact.d_W.moment),
                           .link_W_m = robot::array(contact.link_W),
                           .link_force_W_N = robot::array(contact.contact_W.force),
                           .link_moment_W_Nm = robot::array(contact.contact_W.moment)});
  }
  contact_wrench_.write(out);
}

void EstimationService::report_mode(TimePoint now) noexcept {
  const msg::EstimatorMode mode = to_message(estimate_.mode);
  if (mode == reported_mode_) return;
  msg::Event out{
      .module_id = config_.module_id, .stamp_ns = to_ns(now), .service = "estimation", .machine = "filter"};
  out.from = bus::EnumTraits<msg::EstimatorMode>::names[static_cast<std::size_t>(reported_mode_)];
  out.to = bus::EnumTraits<msg::EstimatorMode>::names[static_cast<std::size_t>(mode)];
  event_.write(out);
  reported_mode_ = mode;
}

}  // namespace eciton::estimation
