// Transitions of the flight modes.
#include "services/control/flight_mode.hpp"

namespace eciton::control {

bool FlightModeMachine::flying() const {
  return mode_ == FlightMode::takeoff || mode_ == FlightMode::hover || mode_ == FlightMode::move ||
         mode_ == FlightMode::land || mode_ == FlightMode::failsafe;
}

const char* FlightModeMachine::arm(bool ready) {
  if (flying()) return "already flying";
  if (!ready) return "the estimator is not ready: wait for a pose and an IMU at rest";
  mode_ = FlightMode::armed;
  return nullptr;
}

const char* FlightModeMachine::disarm() {
  if (flying()) return "flying: land first, or stop to cut the motors";
  mode_ = FlightMode::disarmed;
  return nullptr;
}

const char* FlightModeMachine::takeoff() {
  if (mode_ == FlightMode::disarmed || mode_ == FlightMode::stopped) return "not armed: arm first";
  if (mode_ != FlightMode::armed) return "already flying";
  mode_ = FlightMode::takeoff;
  return nullptr;
}

const char* FlightModeMachine::refuse_unless_free() const {
  switch (mode_) {
    case FlightMode::hover:
    case FlightMode::move: return nullptr;
    case FlightMode::takeoff: return "taking off: wait until it hovers";
    case FlightMode::land: return "landing";
    case FlightMode::failsafe: return "in failsafe: the state is lost";
    case FlightMode::disarmed:
    case FlightMode::armed:
    case FlightMode::stopped: break;
  }
  return "on the ground: take off first";
}

const char* FlightModeMachine::move() {
  if (const char* refusal = refuse_unless_free()) return refusal;
  mode_ = FlightMode::move;
  return nullptr;
}

const char* FlightModeMachine::track() {
  if (const char* refusal = refuse_unless_free()) return refusal;
  mode_ = FlightMode::hover;
  return nullptr;
}

const char* FlightModeMachine::land() {
  if (mode_ == FlightMode::land) return "landing already";
  if (!flying()) return "on the ground";
  mode_ = FlightMode::land;
  return nullptr;
}

void FlightModeMachine::arrived() {
  if (mode_ == FlightMode::takeoff || mode_ == FlightMode::move) mode_ = FlightMode::hover;
}

FlightModeMachine::Change FlightModeMachine::estimation(bool lost) {
  if (lost && flying() && mode_ != FlightMode::failsafe) {
    mode_ = FlightMode::failsafe;
    return Change::lost;
  }
  if (!lost && mode_ == FlightMode::failsafe) {
    mode_ = FlightMode::hover;
    return Change::recovered;
  }
  return Change::none;
}

}  // namespace eciton::control
