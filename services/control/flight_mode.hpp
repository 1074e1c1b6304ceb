// The flight modes of a module and what may follow what. Pure: it is told what happened and says what holds.
#pragma once

namespace eciton::control {

enum class FlightMode {
  disarmed,
  armed,     // motors idle, on the ground
  takeoff,
  hover,
  move,
  land,
  failsafe,  // in the air without a state: the hardware host flies it down
  stopped    // killed: motors off until armed again
};

/// Requests return nullptr when they are granted, otherwise why not (a literal).
class FlightModeMachine {
 public:
  FlightMode mode() const { return mode_; }
  /// Whether pose control is to act (or would, had it a state).
  bool flying() const;

  /// `ready`: the estimator is, and its state is fresh.
  const char* arm(bool ready);
  const char* disarm();
  const char* takeoff();
  const char* move();
  const char* track();  // a reference of the docking service's
  const char* land();
  void stop() { mode_ = FlightMode::stopped; }

  void arrived();  // at the end of a takeoff or a move
  void landed() { mode_ = FlightMode::disarmed; }

  enum class Change { none, lost, recovered };
  /// Told every cycle whether the estimate is lost.
  Change estimation(bool lost);

 private:
  const char* refuse_unless_free() const;
  FlightMode mode_ = FlightMode::disarmed;
};

}  // namespace eciton::control
