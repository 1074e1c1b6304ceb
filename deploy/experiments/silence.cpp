// silence: in the middle of a morph the swarm ring falls silent for five seconds; every member flies on by itself.
#include <algorithm>

#include "deploy/experiments/chain_flight.hpp"

namespace eciton::deploy {
namespace {

constexpr std::uint32_t modules = 3;
constexpr double yaw_rad = 0.6, pitch_rad = 0.3;
constexpr double usual_s = 10, before_s = 3, silent_s = 5, after_s = 5;
// Recovered: all heard, and the greatest contact force for a second no more than it had been (or than this).
constexpr double quiet_N = 0.3, stays_s = 1, limit_s = 20;
constexpr double step_s = 0.02;

Figures run_trial(const ExperimentConfig& config, std::uint32_t trial) {
  ChainFlight flight(config, trial, modules);
  flight.assemble();
  Pilot& pilot = flight.pilot();
  Recorder& recorder = flight.recorder();
  recorder.start();
  pilot.wait(usual_s);
  const std::uint64_t morph = pilot.op().morph(flight.first(), flight.bow(yaw_rad, pitch_rad), 0);
  pilot.wait(before_s);
  const double usual_N = std::max(quiet_N, recorder.figures().contact_force_N_max);

  flight.simulation().silence_swarm(true);
  const double silent_at_s = flight.simulation().elapsed_s();
  pilot.wait(silent_s);
  flight.simulation().silence_swarm(false);
  const double back_at_s = flight.simulation().elapsed_s();
  double recovered_at_s = back_at_s, now_s = back_at_s;
  while (now_s < back_at_s + limit_s && now_s < recovered_at_s + stays_s) {
    pilot.wait(step_s);
    now_s = flight.simulation().elapsed_s();
    const bool recovered = recorder.members_heard() == flight.size() && recorder.contact_force_N() <= usual_N;
    if (!recovered) recovered_at_s = now_s;
  }
  pilot.wait(after_s);
  const FlightFigures f = recorder.figures();

  Figures out;
  out.series = recorder.series();
  out.series["mark_s"] = {silent_at_s, back_at_s};
  out.metrics = {{"base_position_error_m_max", f.position_error_m_max},
                 {"contact_force_N_max", f.contact_force_N_max},
                 {"contact_torque_Nm_max", f.contact_torque_Nm_max},
                 {"recovered_s", recovered_at_s - back_at_s},
                 {"morphed", pilot.follow(morph, 30) == GoalProgress::succeeded ? 1.0 : 0.0}};
  return out;
}

}  // namespace

const Experiment silence_experiment{.name = "silence",
                                    .summary = "the swarm ring falls silent for five seconds during a morph",
                                    .modules = modules,
                                    .has_trials = false,
                                    .breaks = {},
                                    .run_trial = &run_trial,
                                    .summarise = &only_trial};

}  // namespace eciton::deploy
