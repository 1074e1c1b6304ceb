// take(); estimate; publish. What it publishes is made in estimation_service_publish.cpp.
#include "services/estimation/estimation_service.hpp"

#include <algorithm>
#include <cmath>

#include "core/robot/arrays.hpp"

namespace eciton::estimation {
namespace {

constexpr double thrust_share_flying = 0.7;  // of the weight; less: on the floor, or falling

constexpr double pose_silent_s = ErrorStateFilterConfig{}.dead_reckoning_s;
constexpr double observer_gap_s_max = 0.02;  // longer between two states: only the momentum is taken

bool finite(const msg::ExternalWrench& w) {
  const auto all = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  };
  return all(w.force_W_N) && all(w.moment_W_Nm) && all(w.r_W_m) && all(w.port_W_m);
}

}  // namespace

EstimationService::EstimationService(bus::Participant& ring, const EstimationConfig& config,
                                     const robot::Airframe& airframe)
    : config_(config),
      airframe_(airframe),
      wrench_period_(from_s(1 / config.wrench_rate_Hz)),
      observer_({.force_gain_1_s = config.observer_gain_1_s, .moment_gain_1_s = config.observer_gain_1_s}),
      imu_check_({.frozen_samples = config.refuses_frozen ? ImuCheckConfig{}.frozen_samples : 0}),
      pose_check_({.frozen_samples = config.refuses_frozen ? PoseCheckConfig{}.frozen_samples : 0}),
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
      model_errors_(ring.create_writer(topics::model_errors)),
      goal_status_(ring.create_writer(topics::goal_status)),
      event_(ring.create_writer(topics::event)),
      fault_(ring.create_writer(topics::fault)) {}

void EstimationService::load_state(runtime::StateReader& reader) noexcept { reader(saved_at_, zeroing_); }

void EstimationService::step(TimePoint now) noexcept {
  if (first_step_ && now - saved_at_ > runtime::resume_within) zeroing_ = Zeroing();
  if (first_step_ && zeroing_.zeroed() && config_.zeroing) publish_model_errors(now);
  take_chain(now);
  take_zero_requests(now);
  take_actuators(now);
  take_sensors(now);
  watch_silence(now);
  observe(now);
  publish_state(now);
  if (now >= wrench_due_) {
    watch_bus(now);
    publish_external_wrench(now);
    publish_contact_wrench(now);
    wrench_due_ = std::max(wrench_due_ + wrench_period_, now);
  }
  report_mode(now);
  report_refusals(now);
  last_step_ = now;
  first_step_ = false;
}

void EstimationService::take_sensors(TimePoint now) noexcept {
  while (const auto imu = imu_.take()) {
    if (imu->value.module_id != config_.module_id) continue;
    take_imu(imu->value, now);
  }
  while (const auto pose = pose_.take()) {
    if (pose->value.module_id != config_.module_id) continue;
    take_pose(pose->value, now);
  }
  estimate_ = filter_.estimate();
}

void EstimationService::take_imu(const msg::Imu& imu, TimePoint now) noexcept {
  const ImuSample sample{imu.stamp_ns, robot::vector(imu.specific_force_M_m_s2), robot::vector(imu.w_WM_M_rad_s)};
  Refusal refusal = imu_check_.check(sample, to_ns(now));
  if (refusal == Refusal::none) {
    const std::uint64_t gaps = filter_.counters().imu_gaps;
    const ImuVerdict verdict = filter_.update(sample);
    if (verdict == ImuVerdict::repeated) refusal = Refusal::stamp_repeated;
    if (verdict == ImuVerdict::backward) refusal = Refusal::stamp_backward;
    if (filter_.counters().imu_gaps != gaps) pose_check_.forget_stamps();
  }
  if (refusal != Refusal::none) spell(Device::imu).refuse(refusal, to_ns(now));
}

void EstimationService::take_pose(const msg::PoseMeasurement& m, TimePoint now) noexcept {
  Refusal refusal = pose_check_.check({m.stamp_ns, m.p_WB_m, m.q_WB, m.position_std_m, m.attitude_std_rad});
  if (refusal == Refusal::none) {
    const std::uint64_t restarts = filter_.counters().restarts;
    const PoseVerdict verdict = filter_.update(PoseMeasurement{
        m.stamp_ns, {robot::vector(m.p_WB_m), robot::rotation(m.q_WB)}, m.position_std_m, m.attitude_std_rad});
    if (filter_.counters().restarts != restarts) observer_.hold();
    if (verdict == PoseVerdict::rejected) refusal = Refusal::implausible;
    // What the IMU leaves nothing to tie to, silent or new, is no fault of the pose's: only its own age is.
    const Duration age = now - from_ns(m.stamp_ns);
    if (verdict == PoseVerdict::too_old && age > from_s(pose_silent_s)) refusal = Refusal::too_late;
    if (verdict == PoseVerdict::too_new && -age > from_s(ImuCheckConfig{}.ahead_s_max))
      refusal = Refusal::stamp_ahead;
  }
  if (refusal != Refusal::none) spell(Device::pose).refuse(refusal, to_ns(now));
}

void EstimationService::watch_silence(TimePoint now) noexcept {
  const auto silent = [now](const std::optional<TimePoint>& heard, double silent_s) {
    return heard && to_s(now - *heard) > silent_s;
  };
  if (silent(imu_heard_, config_.imu_silent_s)) spell(Device::imu).silent(to_ns(now));
  if (silent(pose_heard_, pose_silent_s)) spell(Device::pose).silent(to_ns(now));
  // Without a good IMU sample the state is what it was then: nobody may fly by it.
  const bool stale = estimate_.stamp_ns != 0 && to_s(now - from_ns(estimate_.stamp_ns)) > config_.imu_silent_s;
  if (stale && estimate_.mode != FilterMode::initialising) estimate_.mode = FilterMode::lost;
}

/// What the bus refused before we saw it, by what that says of the device.
void EstimationService::watch_bus(TimePoint now) noexcept {
  const auto watch = [now](const bus::ReaderStatistics& all, bus::ReaderStatistics& seen, RefusalSpell& spell,
                           std::optional<TimePoint>& heard) {
    const auto refuse = [&](std::uint64_t count, std::uint64_t before, Refusal cause) {
      for (; before < count; ++before) spell.refuse(cause, to_ns(now));
    };
    refuse(all.dropped_malformed, seen.dropped_malformed, Refusal::not_finite);  // the codec lets no other number by
    refuse(all.dropped_late, seen.dropped_late, Refusal::stamp_backward);
    refuse(all.dropped_expired, seen.dropped_expired, Refusal::too_late);
    if (all.received != seen.received) heard = now;  // bad or not, it is not silent
    seen = all;
  };
  watch(imu_.statistics(), imu_dropped_, spell(Device::imu), imu_heard_);
  watch(pose_.statistics(), pose_dropped_, spell(Device::pose), pose_heard_);
}

void EstimationService::take_actuators(TimePoint now) noexcept {
  while (const auto command = rotor_commands_.take()) {
    const msg::RotorCommand& c = command->value;
    if (c.module_id != config_.module_id) continue;
    const bool good = std::all_of(c.rotors.begin(), c.rotors.end(), [](const msg::Rotor& r) {
      return std::isfinite(r.thrust_N) && std::isfinite(r.gimbal_rad[0]) && std::isfinite(r.gimbal_rad[1]);
    });
    if (!good) {
      spell(Device::rotors).refuse(Refusal::not_finite, to_ns(now));
      continue;
    }
    armed_ = c.armed;
    for (std::size_t k = 0; k < airframe_.rotors.size() && k < c.rotors.size(); ++k) {
      rotor_command_[k] = {armed_ ? c.rotors[k].thrust_N : 0, c.rotors[k].gimbal_rad};
    }
  }
  while (const auto joints = joint_state_.take()) {
    if (joints->value.module_id != config_.module_id) continue;
    for (std::size_t k = 0; k < airframe_.joints.size() && k < joints->value.joints.size(); ++k) {
      const double position_rad = joints->value.joints[k].position_rad;
      if (std::isfinite(position_rad)) {
        joint_rad_[k] = position_rad;
      } else {
        spell(Device::joints).refuse(Refusal::not_finite, to_ns(now));
      }
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
    if (!finite(wrench->value)) {
      spell(Device::peers).refuse(Refusal::not_finite, to_ns(now));
      continue;
    }
    for (std::size_t k = 0; k < view_.members.size(); ++k) {
      if (view_.members[k] != wrench->value.module_id) continue;
      heard_[k] = wrench->value;
      heard_at_[k] = now - wrench->age;
    }
  }
}

void EstimationService::observe(TimePoint now) noexcept {
  rotors_.update(std::span(rotor_command_).first(airframe_.rotors.size()),
                 first_step_ ? 0.002 : std::clamp(to_s(now - last_step_), 1e-4, 0.02));
  const std::span<const double> joints = joint_angles();
  const robot::Vector3 c_B = robot::com_offset_B(airframe_, joints);
  const robot::Matrix3& R = estimate_.X_WB.R;
  state_ = {estimate_.X_WB * c_B, estimate_.v_WB + R * estimate_.w_WB_B.cross(c_B)};
  if (estimate_.mode == FilterMode::initialising || estimate_.mode == FilterMode::lost) {
    observer_.hold();
    if (zero_goal_ != 0) answer_zero(zero_goal_, msg::GoalPhase::aborted, "the state is lost", now);
    return;
  }
  // Momentum changed over the time between the two states, whenever they came.
  const double dt_s = static_cast<double>(estimate_.stamp_ns - observed_ns_) * 1e-9;
  if (dt_s == 0) return;
  observed_ns_ = estimate_.stamp_ns;
  if (!(dt_s > 0 && dt_s <= observer_gap_s_max)) observer_.hold();
  const bool observed = observer_.update({.mass_kg = airframe_.mass_kg,
                                          .I_M_kg_m2 = robot::composite_inertia(airframe_, joints),
                                          .v_WM = state_.v_WM,
                                          .w_WM_M = estimate_.w_WB_B,
                                          .R_WM = R,
                                          .known_M = rotors_.wrench_B(c_B)},
                                         dt_s);
  if (!observed) {
    spell(Device::output).refuse(Refusal::not_finite, to_ns(now));
    return;
  }
  const robot::BiasJacobian jacobian_M = robot::bias_jacobian(airframe_, rotors_.rotors(), c_B, R);
  zero(jacobian_M, std::clamp(dt_s, 0.0, observer_gap_s_max), now);
  external_W_ = observer_.wrench_W();
  if (config_.zeroing) external_W_ -= robot::rotate(R, zeroing_.bias_M(jacobian_M));
}

void EstimationService::take_zero_requests(TimePoint now) noexcept {
  while (const auto request = mode_request_.take()) {
    const msg::ModeRequest& r = request->value;
    if (r.module_id != config_.module_id || r.action != msg::ModeAction::zero) continue;
    if (r.correlation_id == zero_goal_ || r.correlation_id == zero_answered_) continue;
    if (zero_goal_ != 0) answer_zero(zero_goal_, msg::GoalPhase::aborted, "asked for anew", now);
    if (const char* reason = not_free()) {
      answer_zero(r.correlation_id, msg::GoalPhase::refused, reason, now);
      continue;
    }
    zero_asked_ = true;
    zero_goal_ = r.correlation_id;
    answer_zero(r.correlation_id, msg::GoalPhase::accepted, "", now);
  }
}

void EstimationService::zero(const robot::BiasJacobian& jacobian_M, double dt_s, TimePoint now) noexcept {
  // By itself, in the first free hover; asked for again, anew. What a peer's touch interrupts begins again.
  const ZeroingPhase before = zeroing_.phase();
  if (not_free() != nullptr) {
    zeroing_interrupted_ = true;
    if (zero_goal_ != 0) {
      answer_zero(zero_goal_, msg::GoalPhase::aborted, not_free(), now);
      zero_asked_ = false;
    }
    return;
  }
  const bool wanted = zero_asked_ || !zeroing_.zeroed();
  const bool measuring = before == ZeroingPhase::measuring;
  if (wanted && (!measuring || zeroing_interrupted_)) zeroing_.start();
  zero_asked_ = zeroing_interrupted_ = false;
  const robot::Wrench wrench_M = robot::rotate(estimate_.X_WB.R.transpose(), observer_.wrench_W());
  zeroing_.update(wrench_M, jacobian_M, state_.v_WM, estimate_.w_WB_B, dt_s);
  if (zeroing_.phase() != before) report_zeroing(before, now);
}

const char* EstimationService::not_free() const {
  double thrust_N = 0;
  for (const robot::RotorOutput& rotor : rotors_.rotors()) thrust_N += rotor.thrust_N;
  if (!armed_ || thrust_N <= thrust_share_flying * airframe_.mass_kg * robot::gravity_m_s2) {
    return "not flying: zero in free hover";
  }
  if (touching_ || view_.members.size() > 1 || view_.epoch != 0) return "in touch with a peer: zero apart from it";
  return nullptr;
}

}  // namespace eciton::estimation
