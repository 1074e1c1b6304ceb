// The phases of a docking.
#include "services/docking/docking_sequence.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::docking {

std::string_view to_text(Failure failure) {
  switch (failure) {
    case Failure::none:
      return "none";
    case Failure::aborted:
      return "aborted";
    case Failure::target_silent:
      return "the target fell silent";
    case Failure::align_time_out:
      return "not aligned in time: is the way to the port free?";
    case Failure::too_many_recoveries:
      return "too many recoveries: is the port blocked?";
    case Failure::no_view:
      return "latched, but the modules did not agree on a view";
    case Failure::latch_stuck:
      return "a latch did not report open, or the view did not let go";
  }
  return "unknown";
}

void DockingSequence::begin(PortKind target_port, const Pose& X_TF) {
  target_port_ = target_port;
  out_ = {};
  out_.outcome = Outcome::running;
  out_.X_TF_reference = X_TF;
  out_.gap_m_commanded = relation(X_TF, target_port).gap_m;
  pending_ = Failure::none;
  path_.start(X_TF, target_port);
}

void DockingSequence::start_docking(PortKind target_port, const Pose& X_TF, std::span<const Vector3> bodies_F) {
  path_.carry(target_port, bodies_F);
  begin(target_port, X_TF);
  enter(DockingPhase::align);
}

void DockingSequence::start_undocking(PortKind target_port, const Pose& X_TF) {
  begin(target_port, X_TF);
  out_.gap_m_commanded = 0;
  enter(DockingPhase::release);
}

void DockingSequence::enter(DockingPhase phase) {
  out_.phase = phase;
  in_phase_s_ = aligned_s_ = pushing_s_ = unlatched_s_ = latched_s_ = 0;
  out_.engage_latch =
      phase == DockingPhase::approach || phase == DockingPhase::assembly || phase == DockingPhase::docked;
}

const DockingOutputs& DockingSequence::update(double dt_s, const DockingInputs& in) {
  out_.measured = relation(in.X_TF, target_port_);
  out_.v_TF_reference.setZero();
  out_.w_TF_reference.setZero();
  // No time has passed on a first step, or where a clock stands still.
  if (out_.outcome != Outcome::running || !(dt_s > 0) || give_up(in)) return out_;
  in_phase_s_ += dt_s;
  switch (out_.phase) {
    case DockingPhase::align:
      align(dt_s, in);
      break;
    case DockingPhase::approach:
      approach(dt_s, in);
      break;
    case DockingPhase::assembly:
      assemble(dt_s, in);
      break;
    case DockingPhase::recover:
      recover(dt_s);
      break;
    case DockingPhase::release:
      release(in);
      break;
    case DockingPhase::retreat:
      retreat(dt_s);
      break;
    case DockingPhase::idle:
    case DockingPhase::docked:
      break;
  }
  return out_;
}

bool DockingSequence::give_up(const DockingInputs& in) {
  const bool on_the_way = out_.phase == DockingPhase::align || out_.phase == DockingPhase::approach ||
                          out_.phase == DockingPhase::assembly || out_.phase == DockingPhase::recover;
  // A closed latch is no reason to tear oneself away: silence never removes a link.
  if (!on_the_way || in.latch == LatchStatus::latched) return false;
  if (!in.abort && in.target_fresh) return false;
  fail_by_retreat(in.abort ? Failure::aborted : Failure::target_silent);
  return true;
}

void DockingSequence::fail_by_retreat(Failure failure) {
  // Beside the corridor in front of the port, standing still is better than any move.
  const PortRelation at = relation(out_.X_TF_reference, target_port_);
  if (at.gap_m > config_.retreat_gap_m || at.radial_m > config_.recover_radial_m)
    return finish(Outcome::failed, failure);
  pending_ = failure;
  out_.gap_m_commanded = out_.measured.gap_m;
  enter(DockingPhase::retreat);
}

void DockingSequence::finish(Outcome outcome, Failure failure) {
  enter(outcome == Outcome::docked ? DockingPhase::docked : DockingPhase::idle);
  out_.outcome = outcome;
  out_.failure = failure;
}

void DockingSequence::align(double dt_s, const DockingInputs& in) {
  path_.update(dt_s, config_.standoff_m, in.bodies_T);
  out_.X_TF_reference = path_.X_TF();
  out_.v_TF_reference = path_.v_TF();
  out_.w_TF_reference = path_.w_TF();
  out_.gap_m_commanded = relation(path_.X_TF(), target_port_).gap_m;
  const PortRelation& at = out_.measured;
  const bool aligned = path_.arrived() && std::abs(at.gap_m - config_.standoff_m) < config_.align_axial_m &&
                       at.radial_m < config_.align_radial_m && at.attitude_rad < config_.align_attitude_rad;
  aligned_s_ = aligned ? aligned_s_ + dt_s : 0;
  if (aligned_s_ >= config_.align_hold_s) {
    enter(DockingPhase::approach);
  } else if (in_phase_s_ > (path_.carries() ? config_.chain_align_time_out_s : config_.align_time_out_s)) {
    fail_by_retreat(Failure::align_time_out);
  }
}

void DockingSequence::approach(double dt_s, const DockingInputs& in) {
  move_gap(dt_s, config_.gap_m_min, config_.approach_speed_m_s);
  pushing_s_ = out_.gap_m_commanded <= config_.gap_m_min ? pushing_s_ + dt_s : 0;
  out_.declared_by = declaration(in);
  if (out_.declared_by != DeclaredBy::nothing || in.latch == LatchStatus::latched) {
    enter(DockingPhase::assembly);
  } else if (out_.measured.radial_m > config_.recover_radial_m || pushing_s_ > config_.push_time_out_s) {
    try_again();
  }
}

DeclaredBy DockingSequence::declaration(const DockingInputs& in) const {
  const PortRelation& at = out_.measured;
  if (std::abs(at.gap_m) < config_.declare_axial_m && at.radial_m < config_.declare_radial_m) return DeclaredBy::pose;
  if (in.push_N > config_.declare_push_N && out_.gap_m_commanded < config_.declare_push_gap_m)
    return DeclaredBy::wrench;
  return DeclaredBy::nothing;
}

void DockingSequence::assemble(double dt_s, const DockingInputs& in) {
  if (in.latch != LatchStatus::latched) {
    latched_s_ = 0;
    unlatched_s_ += dt_s;
    move_gap(dt_s, config_.gap_m_min, config_.approach_speed_m_s);
    if (unlatched_s_ <= config_.latch_time_out_s) return;
    ++out_.false_declarations;
    return try_again();
  }
  unlatched_s_ = 0;
  latched_s_ += dt_s;
  // From pushing to rest within `settle_s`, whatever the ramp had come to.
  move_gap(dt_s, 0, -config_.gap_m_min / config_.settle_s);
  if (in.view_active) {
    finish(Outcome::docked, Failure::none);
  } else if (latched_s_ > config_.view_time_out_s) {
    pending_ = Failure::no_view;
    enter(DockingPhase::release);
  }
}

void DockingSequence::try_again() {
  out_.declared_by = DeclaredBy::nothing;
  if (out_.recoveries >= config_.recoveries_max) return fail_by_retreat(Failure::too_many_recoveries);
  ++out_.recoveries;
  enter(DockingPhase::recover);
}

void DockingSequence::recover(double dt_s) {
  move_gap(dt_s, config_.standoff_m, path_.carries() ? config_.chain_recover_speed_m_s : config_.recover_speed_m_s);
  if (out_.gap_m_commanded < config_.standoff_m) return;
  path_.start(out_.X_TF_reference, target_port_);
  enter(DockingPhase::align);
}

void DockingSequence::release(const DockingInputs& in) {
  const bool open = in.latch == LatchStatus::open && in.target_latch == LatchStatus::open;
  if (open && !in.view_active) {
    enter(DockingPhase::retreat);
    out_.X_TF_reference = {out_.gap_m_commanded * outward_T(target_port_), robot::Matrix3::Identity()};
  } else if (in_phase_s_ > config_.release_time_out_s) {
    finish(Outcome::failed, Failure::latch_stuck);
  }
}

void DockingSequence::retreat(double dt_s) {
  // From rest: a step of the speed would be a step of the thrust.
  move_gap(dt_s, config_.retreat_gap_m,
           std::min(config_.retreat_speed_m_s, config_.retreat_acceleration_m_s2 * in_phase_s_));
  if (out_.gap_m_commanded < config_.retreat_gap_m) return;
  finish(pending_ == Failure::none ? Outcome::undocked : Outcome::failed, pending_);
}

void DockingSequence::move_gap(double dt_s, double to_m, double speed_m_s) {
  double& gap_m = out_.gap_m_commanded;
  const double before_m = gap_m;
  gap_m += std::clamp(to_m - gap_m, -speed_m_s * dt_s, speed_m_s * dt_s);
  const Vector3 outward = outward_T(target_port_);
  out_.X_TF_reference = {gap_m * outward, robot::Matrix3::Identity()};
  out_.v_TF_reference = (gap_m - before_m) / dt_s * outward;
}

}  // namespace eciton::docking
