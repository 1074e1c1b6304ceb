// Holding still for a follower.
#include "services/docking/target_sequence.hpp"

namespace eciton::docking {

void TargetSequence::accept() {
  out_ = {};
  silent_s_ = latched_s_ = releasing_s_ = 0;
  enter(DockingPhase::align);
}

void TargetSequence::enter(DockingPhase phase) {
  out_.phase = phase;
  out_.hold_still = phase != DockingPhase::idle && phase != DockingPhase::docked;
  out_.engage_latch =
      phase == DockingPhase::approach || phase == DockingPhase::assembly || phase == DockingPhase::docked;
}

void TargetSequence::end(Failure failure, bool engaged) {
  enter(DockingPhase::idle);
  out_.failure = failure;
  out_.engage_latch = engaged;
}

const TargetOutputs& TargetSequence::update(double dt_s, const TargetInputs& in) {
  switch (out_.phase) {
    case DockingPhase::idle:
      break;
    case DockingPhase::align:
    case DockingPhase::approach:
    case DockingPhase::recover:
    case DockingPhase::retreat:
      before_latching(dt_s, in);
      break;
    case DockingPhase::assembly:
    case DockingPhase::docked:
      after_latching(dt_s, in);
      break;
    case DockingPhase::release:
      let_go(dt_s, in);
      break;
  }
  return out_;
}

void TargetSequence::before_latching(double dt_s, const TargetInputs& in) {
  if (in.latch == LatchStatus::latched) return enter(DockingPhase::assembly);
  if (in.abort) return end(Failure::aborted, false);
  silent_s_ = in.follower_fresh ? 0 : silent_s_ + dt_s;
  if (silent_s_ > config_.follower_time_out_s) return end(Failure::target_silent, false);
  if (!in.follower_fresh) return;
  switch (in.follower_phase) {
    case DockingPhase::idle:
      end(Failure::aborted, false);
      break;
    case DockingPhase::align:
    case DockingPhase::recover:
    case DockingPhase::retreat:
      enter(in.follower_phase);
      break;
    // Its latch may report before ours: engaged, ours follows or its own time-out calls it off.
    case DockingPhase::approach:
    case DockingPhase::assembly:
    case DockingPhase::docked:
      enter(DockingPhase::approach);
      break;
    case DockingPhase::release:
      enter(DockingPhase::release);
      break;
  }
}

void TargetSequence::after_latching(double dt_s, const TargetInputs& in) {
  if (in.follower_fresh && in.follower_phase == DockingPhase::release) return enter(DockingPhase::release);
  if (in.latch != LatchStatus::latched) {
    // Lost again before it held, or torn off: the claim is withdrawn elsewhere.
    silent_s_ = latched_s_ = 0;
    return out_.phase == DockingPhase::docked ? end(Failure::none, false) : enter(DockingPhase::approach);
  }
  if (out_.phase == DockingPhase::docked) return;
  latched_s_ = in.view_active ? 0 : latched_s_ + dt_s;
  if (in.view_active) {
    enter(DockingPhase::docked);
  } else if (latched_s_ > config_.view_time_out_s) {
    out_.failure = Failure::no_view;
    enter(DockingPhase::release);
  }
}

void TargetSequence::let_go(double dt_s, const TargetInputs& in) {
  releasing_s_ += dt_s;
  if (in.latch == LatchStatus::open) {
    end(out_.failure, false);
  } else if (releasing_s_ > config_.release_time_out_s) {
    end(Failure::latch_stuck, false);
  }
}

}  // namespace eciton::docking
