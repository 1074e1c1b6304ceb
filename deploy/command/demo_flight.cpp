// The steps of a demo's flight, in their order.
#include "deploy/command/demo_flight.hpp"

#include "core/base/wall_clock.hpp"

namespace eciton::deploy {
namespace {

constexpr double morph_angle_rad = 0.4;
constexpr double morph_pitch_rad = 0.15;
constexpr double morph_rate_rad_s = 0.12;
constexpr double morph_timeout_s = 30;  // on the modules' clock
constexpr double settle_s = 2.5;        // of a hover before it counts as one

}  // namespace

std::optional<FlightFailure> DemoFlight::fly() {
  std::optional<FlightFailure> failure;
  try {
    wait_for_modules();
    arm_and_take_off();
    hover_until_zeroed();
    dock_all();
    hover_as_one_body();
    morph();
    undock_all();
    result_.separated = true;
    spread_and_land();
  } catch (const FlightFailure& failed) {
    failure = failed;
  }
  result_.figures = figures_;
  result_.simulated_s = now_s();
  result_.wall_s = to_s(monotonic_now() - wall_begin_);
  return failure;
}

void DemoFlight::dock_all() {
  for (std::size_t k = 1; k < ids_.size(); ++k) {
    const std::uint32_t follower = ids_[k], target = target_for(follower);
    const GoalReport& report = *operator_.report(dock(follower));
    DockingRecord record{.follower = follower,
                         .target = target,
                         .time_s = to_s(report.ended_at - report.accepted_at),
                         .declared_by = {}};
    if (const auto& docking = operator_.fleet().find(follower)->docking) {
      record.declared_by = name_of(docking->declared_by);
      record.recoveries = docking->recoveries;
    }
    result_.dockings.push_back(record);
    agree(k + 1);
  }
  result_.assembled = true;
}

void DemoFlight::hover_as_one_body() {
  begin("hover as one body, chain " + members_text(*view_of(ids_.front())), DemoPhase::assembled);
  hover(settle_s);
}

void DemoFlight::morph() {
  const std::size_t joints = 2 * ids_.size();
  std::vector<double> bent(joints, 0.0);
  // A bow: the yaw joints, male side, of all but the last member, and the pitch joints, female side, of all
  // but the first; the outer ones move nothing.
  for (std::size_t k = 0; k + 1 < ids_.size(); ++k) {
    bent[2 * k] = morph_angle_rad;
    bent[2 * (k + 1) + 1] = k % 2 == 0 ? morph_pitch_rad : -morph_pitch_rad;
  }
  begin("morph into a bow", DemoPhase::morphing);
  finish({operator_.morph(ids_.front(), bent, morph_rate_rad_s)}, morph_timeout_s);
  begin("and back to straight", DemoPhase::morphing);
  finish({operator_.morph(ids_.back(), std::vector<double>(joints, 0.0), morph_rate_rad_s)}, morph_timeout_s);
  result_.morphed = true;
  phase_ = DemoPhase::assembled;
  hover(1);
}

}  // namespace eciton::deploy
