// The flight modes of one module as a pure transition function. Requests are granted or refused with a
// reason; what happens by itself (arriving, landing, losing the state) is a transition too.
#pragma once

#include <optional>

namespace eciton::control {

enum class FlightMode { disarmed, armed, takeoff, hover, move, land, failsafe, stopped };
enum class FlightRequest { arm, disarm, stop, takeoff, go_to, land };

const char* name(FlightMode mode);

struct FlightModeConfig {
  double state_age_s_max = 0.1;  // older, in the air: fail-safe
  double recovered_s = 0.3;      // the state must be good for so long before hover is resumed
};

/// What the mode depends on, at one time.
struct FlightConditions {
  bool state_ready = false;   // the estimator says ready
  bool state_usable = false;  // ready or dead reckoning
  double state_age_s = 1e9;   // of the last state
  double state_good_s = 0;    // usable and fresh without a break for so long
  bool trajectory_finished = false;
  bool landed = false;
  bool duplicate_id = false;  // another module carries our id
  bool rotors_known = true;   // false: just started, and they may be turning under the hardware host's safe output
  bool emergency_descent_over = false;
};

struct FlightDecision {
  FlightMode mode = FlightMode::disarmed;
  bool accepted = true;     // of the request, if there was one
  const char* reason = "";  // of a refusal, or of a transition by itself; a static string
};

constexpr bool flying(FlightMode mode) {
  return mode == FlightMode::takeoff || mode == FlightMode::hover || mode == FlightMode::move ||
         mode == FlightMode::land || mode == FlightMode::failsafe;
}
/// Rotors turn.
constexpr bool powered(FlightMode mode) { return mode == FlightMode::armed || flying(mode); }

/// One request. `stop` is granted in any mode; motors off at once.
FlightDecision decide(FlightMode mode, FlightRequest request, const FlightConditions& now,
                      const FlightModeConfig& config = {});
/// What happens by itself.
FlightDecision advance(FlightMode mode, const FlightConditions& now, const FlightModeConfig& config = {});

struct TouchdownConfig {
  double force_share_max = 0.7;  // of the weight, asked of the rotors
  double speed_m_s_max = 0.1;
  double for_s = 0.4;
};

/// Standing on the ground while landing: little thrust is asked for and still nothing falls.
class TouchdownDetector {
 public:
  explicit TouchdownDetector(const TouchdownConfig& config = {}) : config_(config) {}
  bool update(double demanded_force_N, double weight_N, double vertical_speed_m_s, double dt_s);
  void reset() { standing_s_ = 0; }

 private:
  TouchdownConfig config_;
  double standing_s_ = 0;
};

}  // namespace eciton::control
