// The real ControlService, told by topics that it hovers.
#include "benchmarks/jitter/control_work.hpp"

#include "core/base/wall_clock.hpp"
#include "core/robot/airframe.hpp"

namespace eciton::bench {
namespace {

constexpr double height_m = 1.0;

}  // namespace

ControlWork::ControlWork(bus::Participant& ring, std::uint32_t module_id, Duration period, std::size_t at_most)
    : module_id_(module_id),
      period_(period),
      control_(ring, {.module_id = module_id}, robot::legion(false)),
      state_(ring.create_writer(topics::module_state)),
      mode_(ring.create_writer(topics::mode_request)),
      goal_(ring.create_writer(topics::flight_goal)),
      rotors_(ring.create_writer(topics::rotor_state)) {
  late_us_.reserve(at_most);
}

void ControlWork::step(TimePoint now) noexcept {
  if (entry_ != nullptr && late_us_.size() < late_us_.capacity()) {
    late_us_.push_back(to_s(monotonic_now() - entry_->next_due) * 1e6);
  }
  fly(now);
  control_.step(now);
  msg::Heartbeat heartbeat;
  control_.describe(heartbeat);
  flies_ = heartbeat.flight_mode != msg::FlightMode::disarmed && heartbeat.flight_mode != msg::FlightMode::armed;
  ++steps_;
}

/// A state that stands still at the height it was told to take.
void ControlWork::fly(TimePoint now) noexcept {
  msg::ModuleState state;
  state.module_id = module_id_;
  state.stamp_ns = to_ns(now);
  state.mode = msg::EstimatorMode::ready;
  state.p_WM_m = {0, 0, height_m};
  state.q_WM = {1, 0, 0, 0};
  state_.write(state);
  rotors_.write({.module_id = module_id_, .stamp_ns = to_ns(now), .armed = flies_, .battery_V = 0, .rotors = {}});
  if (flies_) return;
  if (steps_ % 10 == 1) {
    msg::ModeRequest arm;
    arm.module_id = module_id_;
    arm.stamp_ns = to_ns(now);
    arm.correlation_id = steps_;
    arm.action = msg::ModeAction::arm;
    mode_.write(arm);
  } else if (steps_ % 10 == 2) {
    msg::FlightGoal goal;
    goal.module_id = module_id_;
    goal.stamp_ns = to_ns(now);
    goal.correlation_id = steps_;
    goal.action = msg::FlightAction::takeoff;
    goal.p_WM_m = {0, 0, height_m};
    goal.q_WM = {1, 0, 0, 0};
    goal_.write(goal);
  }
}

}  // namespace eciton::bench
