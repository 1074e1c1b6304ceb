// The module's own ring, on the wall clock.
#include "benchmarks/path/ring_participants.hpp"

#include <array>

#include "core/base/wall_clock.hpp"
#include "hal/sim/frames.hpp"

namespace eciton::bench {
namespace {

constexpr double takeoff_height_m = 0.8;
constexpr Duration ask_pause = std::chrono::milliseconds(300);

}  // namespace

RingObserver::RingObserver(const bus::ParticipantConfig& config, std::size_t commands_max)
    : ring_(config), commands_(ring_.create_reader(topics::rotor_command)) {
  ring_.set_all_wake(false);
  seen_.reserve(commands_max);
}

void RingObserver::poll() {
  ring_.set_now(wall_now());
  while (const auto command = commands_.take()) {
    if (seen_.size() == seen_.capacity()) continue;
    std::array<RotorPrint, hal::sim::max_rotors> rotors;
    for (std::size_t k = 0; k < command->value.rotors.size(); ++k) {
      rotors[k] = {command->value.rotors[k].thrust_N, command->value.rotors[k].gimbal_rad};
    }
    seen_.push_back({command->value.stamp_ns, command->value.state_stamp_ns, command_print(rotors)});
  }
}

Pilot::Pilot(const bus::ParticipantConfig& config, std::uint32_t module_id)
    : ring_(config),
      module_id_(module_id),
      heartbeat_(ring_.create_reader(topics::heartbeat)),
      status_(ring_.create_reader(topics::goal_status)),
      mode_(ring_.create_writer(topics::mode_request)),
      goal_(ring_.create_writer(topics::flight_goal)) {}

void Pilot::poll() {
  ring_.set_now(wall_now());
  while (const auto beat = heartbeat_.take()) beats_[beat->value.service.c_str()] = beat->value;
  while (const auto status = status_.take()) {
    if (status->value.correlation_id == correlation_) answer_ = status->value;
  }
}

bool Pilot::hovers() const {
  const auto control = beats_.find("control");
  return control != beats_.end() && control->second.flight_mode == msg::FlightMode::hover;
}

void Pilot::take_off(Duration now) {
  if (now < ask_due_) return;
  ask_due_ = now + ask_pause;
  correlation_ = static_cast<std::uint64_t>(to_ns(wall_now()));
  const msg::FlightMode mode = beats_["control"].flight_mode;
  if (mode == msg::FlightMode::disarmed) arm();
  if (mode == msg::FlightMode::armed) ask_for_takeoff();
}

void Pilot::arm() {
  mode_.write({.module_id = module_id_,
               .stamp_ns = to_ns(wall_now()),
               .correlation_id = correlation_,
               .action = msg::ModeAction::arm});
}

void Pilot::ask_for_takeoff() {
  msg::FlightGoal goal;
  goal.module_id = module_id_;
  goal.stamp_ns = to_ns(wall_now());
  goal.correlation_id = correlation_;
  goal.action = msg::FlightAction::takeoff;
  goal.p_WM_m[2] = takeoff_height_m;
  goal.q_WM = {1, 0, 0, 0};
  goal_.write(goal);
}

std::vector<msg::Heartbeat> Pilot::heartbeats() const {
  std::vector<msg::Heartbeat> all;
  for (const auto& [name, beat] : beats_) all.push_back(beat);
  return all;
}

}  // namespace eciton::bench
