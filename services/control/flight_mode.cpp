// Transitions of the flight modes.
#include "services/control/flight_mode.hpp"

#include <cmath>

namespace eciton::control {
namespace {

FlightDecision refused(FlightMode mode, const char* reason) { return {mode, false, reason}; }
FlightDecision granted(FlightMode mode) { return {mode, true, ""}; }

/// Why the state is not good enough to begin something, or null.
const char* state_fault(const FlightConditions& now, const FlightModeConfig& config) {
  if (!(now.state_age_s <= config.state_age_s_max)) return "no fresh module state; is estimation running?";
  if (!now.state_ready) return "estimation is not ready; wait for pose measurements";
  return nullptr;
}

FlightDecision decide_arm(FlightMode mode, const FlightConditions& now, const FlightModeConfig& config) {
  if (mode == FlightMode::armed) return granted(mode);
  if (mode == FlightMode::stopped) return refused(mode, "stopped; disarm first");
  if (mode != FlightMode::disarmed) return refused(mode, "already flying");
  if (now.duplicate_id) return refused(mode, "another module has this id; change one");
  if (!now.rotors_known) return refused(mode, "the hardware host says nothing, or is flying it down; wait");
  if (const char* fault = state_fault(now, config)) return refused(mode, fault);
  return granted(FlightMode::armed);
}

FlightDecision decide_motion(FlightMode mode, FlightMode next, const FlightConditions& now,
                             const FlightModeConfig& config) {
  switch (mode) {
    case FlightMode::disarmed:
      return refused(mode, "disarmed; arm and take off first");
    case FlightMode::armed:
      return refused(mode, "on the ground; take off first");
    case FlightMode::stopped:
      return refused(mode, "stopped; disarm first");
    case FlightMode::failsafe:
      return refused(mode, "in fail-safe; the state was lost");
    case FlightMode::takeoff:
      if (next == FlightMode::move) return refused(mode, "taking off; wait until it hovers");
      break;
    case FlightMode::land:
      if (next == FlightMode::move) return refused(mode, "landing; wait until it is down");
      break;
    default:
      break;
  }
  if (next == FlightMode::move) {
    if (const char* fault = state_fault(now, config)) return refused(mode, fault);
  }
  return granted(next);
}

}  // namespace

const char* name(FlightMode mode) {
  switch (mode) {
    case FlightMode::disarmed:
      return "disarmed";
    case FlightMode::armed:
      return "armed";
    case FlightMode::takeoff:
      return "takeoff";
    case FlightMode::hover:
      return "hover";
    case FlightMode::move:
      return "move";
    case FlightMode::land:
      return "land";
    case FlightMode::failsafe:
      return "failsafe";
    case FlightMode::stopped:
      return "stopped";
  }
  return "?";
}

FlightDecision decide(FlightMode mode, FlightRequest request, const FlightConditions& now,
                      const FlightModeConfig& config) {
  switch (request) {
    case FlightRequest::stop:
      return granted(FlightMode::stopped);
    case FlightRequest::arm:
      return decide_arm(mode, now, config);
    case FlightRequest::disarm:
      if (flying(mode)) return refused(mode, "flying; land first, or stop");
      return granted(FlightMode::disarmed);
    case FlightRequest::takeoff:
      if (mode == FlightMode::disarmed) return refused(mode, "disarmed; arm first");
      if (mode == FlightMode::stopped) return refused(mode, "stopped; disarm and arm first");
      if (mode != FlightMode::armed) return refused(mode, "already flying");
      if (const char* fault = state_fault(now, config)) return refused(mode, fault);
      return granted(FlightMode::takeoff);
    case FlightRequest::go_to:
      return decide_motion(mode, FlightMode::move, now, config);
    case FlightRequest::land:
      return decide_motion(mode, FlightMode::land, now, config);
  }
  return refused(mode, "unknown request");
}

FlightDecision advance(FlightMode mode, const FlightConditions& now, const FlightModeConfig& config) {
  const bool state_lost = !now.state_usable || !(now.state_age_s <= config.state_age_s_max);
  switch (mode) {
    case FlightMode::disarmed:
    case FlightMode::stopped:
      return granted(mode);
    case FlightMode::armed:
      if (state_lost) return {FlightMode::disarmed, true, "state lost on the ground"};
      if (now.duplicate_id) return {FlightMode::disarmed, true, "another module has this id"};
      return granted(mode);
    case FlightMode::failsafe:
      if (now.landed || now.emergency_descent_over) return {FlightMode::disarmed, true, "down after fail-safe"};
      if (!state_lost && now.state_good_s >= config.recovered_s) return {FlightMode::hover, true, "state is back"};
      return granted(mode);
    case FlightMode::takeoff:
    case FlightMode::hover:
    case FlightMode::move:
    case FlightMode::land:
      break;
  }
  if (state_lost) {
    return {FlightMode::failsafe, true, now.state_usable ? "state older than its limit" : "estimation lost"};
  }
  if (mode == FlightMode::land && now.landed) return {FlightMode::disarmed, true, "landed"};
  if ((mode == FlightMode::takeoff || mode == FlightMode::move) && now.trajectory_finished) {
    return {FlightMode::hover, true, "arrived"};
  }
  return granted(mode);
}

bool TouchdownDetector::update(double demanded_force_N, double weight_N, double vertical_speed_m_s, double dt_s) {
  const bool standing =
      demanded_force_N < config_.force_share_max * weight_N && std::abs(vertical_speed_m_s) < config_.speed_m_s_max;
  standing_s_ = standing ? standing_s_ + dt_s : 0;
  return standing_s_ >= config_.for_s;
}

}  // namespace eciton::control
