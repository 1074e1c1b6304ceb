// The target's side of a docking: hold still, engage the latch, and let go when the follower gives up or is
// lost. It follows the follower's word; what closes and opens a link is the latch alone.
#pragma once

#include "services/docking/docking_sequence.hpp"

namespace eciton::docking {

struct TargetConfig {
  double follower_time_out_s = 1.0;  // silent for so long mid-approach: give up
  double view_time_out_s = 10;       // latched, but there is no view with both in it
  double release_time_out_s = 5;     // until the latch reports open
};

struct TargetInputs {
  bool follower_fresh = false;
  DockingPhase follower_phase = DockingPhase::idle;  // as it says, with us as its peer; else idle
  LatchStatus latch = LatchStatus::open;             // of the target's port
  bool view_active = false;                          // a view with both modules in it is active here
  bool abort = false;                                // ends what has not latched yet
};

struct TargetOutputs {
  DockingPhase phase = DockingPhase::idle;  // idle: not a target, or not any more
  Failure failure = Failure::none;          // of the last docking
  bool hold_still = false;                  // take no flight goals of one's own
  bool engage_latch = false;                // of the target's port; the last word stands after the end
};

/// Real-time safe. Begins with `accept`; one object per module.
class TargetSequence {
 public:
  explicit TargetSequence(const TargetConfig& config) : config_(config) {}

  /// The follower has named us: from its first sample in a phase that is not idle.
  void accept();
  const TargetOutputs& update(double dt_s, const TargetInputs& in);
  const TargetOutputs& outputs() const { return out_; }

 private:
  void enter(DockingPhase phase);
  void end(Failure failure, bool engaged);
  void before_latching(double dt_s, const TargetInputs& in);
  void after_latching(double dt_s, const TargetInputs& in);
  void let_go(double dt_s, const TargetInputs& in);

  TargetConfig config_;
  TargetOutputs out_;
  double silent_s_ = 0;
  double latched_s_ = 0;
  double releasing_s_ = 0;
};

}  // namespace eciton::docking
