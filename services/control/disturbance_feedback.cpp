// Filtered feedback of the external wrench.
#include "services/control/disturbance_feedback.hpp"

#include <cmath>

namespace eciton::control {

using robot::Vector3;

FeedbackPhase feedback_phase(bool docking, double commanded_gap_m, bool declared,
                             const DisturbanceFeedbackConfig& config) {
  if (declared) return FeedbackPhase::decay;
  return docking && commanded_gap_m < config.freeze_gap_m ? FeedbackPhase::freeze : FeedbackPhase::follow;
}

robot::Wrench DisturbanceFeedback::update(const robot::Wrench& external_W, FeedbackPhase phase, double dt_s) {
  const auto limited = [](const Vector3& v, double size) { return Vector3(v.cwiseMax(-size).cwiseMin(size)); };
  if (phase == FeedbackPhase::follow) {
    const double share = 1 - std::exp(-config_.rate_1_s * dt_s);
    held_W_.force += share * (limited(external_W.force, config_.force_N_max) - held_W_.force);
    held_W_.moment += share * (limited(external_W.moment, config_.moment_Nm_max) - held_W_.moment);
  } else if (phase == FeedbackPhase::decay) {
    held_W_ = held_W_ * std::exp(-dt_s / config_.decay_time_constant_s);
  }
  return feed_forward_W();
}

}  // namespace eciton::control
