// In free flight and docking the external wrench is fed back: w_ff = -w_ext, filtered. Close to contact it
// freezes, or it would push back against the docking itself; once docked it decays.
#pragma once

#include "core/robot/frames.hpp"

namespace eciton::control {

struct DisturbanceFeedbackConfig {
  double rate_1_s = 20;
  double freeze_gap_m = 0.05;  // commanded gap below which it freezes
  double decay_time_constant_s = 1.0;
  double force_N_max = 12;  // per axis
  double moment_Nm_max = 2;
};

enum class FeedbackPhase {
  follow,
  freeze,
  decay,  // docked: from here on contact forces are no disturbance
};

/// Which phase a docking is in: no gap commanded (free flight) follows.
FeedbackPhase feedback_phase(bool docking, double commanded_gap_m, bool declared,
                             const DisturbanceFeedbackConfig& config = {});

/// Real-time safe; one thread.
class DisturbanceFeedback {
 public:
  explicit DisturbanceFeedback(const DisturbanceFeedbackConfig& config = {}) : config_(config) {}

  /// `external_W`: the observer's output, world axes, about the composite centre of mass.
  robot::Wrench update(const robot::Wrench& external_W, FeedbackPhase phase, double dt_s);
  void reset() { held_W_ = {}; }
  robot::Wrench feed_forward_W() const { return -held_W_; }

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.held_W_);
  }

 private:
  DisturbanceFeedbackConfig config_;
  robot::Wrench held_W_;
};

}  // namespace eciton::control
