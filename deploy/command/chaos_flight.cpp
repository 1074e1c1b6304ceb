// Strike, look, judge.
#include "deploy/command/chaos_flight.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/wall_clock.hpp"

namespace eciton::deploy {
namespace {

constexpr double look_on_s = 1.5;  // after a blow, before anything is said to be settled
constexpr double approach_gap_m_max = 0.9, approach_timeout_s = 30, dock_timeout_s = 60;
constexpr double apart_timeout_s = 30;
constexpr double heard_s = 0.2;  // at the most since a module said where it is

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

ChaosFlight::ChaosFlight(const DemoFleet& fleet, Launches& launches, const runtime::StopFlag& stop, DemoView& view,
                         FaultInjector injector, const ChaosPlan& plan)
    : FleetFlight(fleet, launches, stop, view), plan_(plan), injector_(std::move(injector)) {}

std::optional<FlightFailure> ChaosFlight::fly() {
  try {
    wait_for_modules();
    arm_and_take_off();
    hover_until_zeroed();
    bool assembled = false;
    for (const ChaosCell& cell : plan_.cells) {
      if (cell.stage == FlightStage::assembled && !assembled) {
        for (std::size_t k = 1; k < ids_.size(); ++k) {
          dock(ids_[k]);
          agree(k + 1);
        }
        hover(2);
        assembled = true;
      }
      begin(cell.text(), DemoPhase::other);
      if (cell.stage == FlightStage::approach) {
        approach_and_strike(cell);
      } else {
        strike(cell);
        // What has fallen is lifted again, so that the next blow strikes what flies.
        if (cell.stage == FlightStage::separated && !outcomes_.back().broken.empty()) go_home();
      }
      if (&cell == &plan_.cells.front()) growth_.begin(launches_);
    }
    most_growth_ = growth_.most(launches_);
    undock_all();
    spread_and_land();
  } catch (const FlightFailure& failed) {
    return failed;
  }
  return std::nullopt;
}

void ChaosFlight::on_end(Launch& launch, const ChildReport& report) {
  const bool meant =
      striking_ != nullptr && launch.plan().module_id == striking_->module_id && report.name == striking_->replaced();
  if (!meant) ended_.push_back(describe(launch, report));
  if (launch.plan().module_id == 0) FleetFlight::on_end(launch, report);  // without the world nothing flies
}

/// The second module docks with the first; it is struck on its way.
void ChaosFlight::approach_and_strike(const ChaosCell& cell) {
  const std::uint32_t follower = ids_[1];
  const std::uint64_t goal = operator_.dock(follower, ids_[0]);
  const auto over = [&] { return is_over(operator_.report(goal)->progress); };
  const auto near = [&] {
    const KnownModule* module = operator_.fleet().find(follower);
    return module->docking && module->docking->phase == msg::DockingPhase::approach &&
           module->docking->axial_gap_m < approach_gap_m_max;
  };
  wait_until([&] { return near() || over(); }, approach_timeout_s, [] { return "the approach does not begin"; });
  if (over()) fail(operator_.report(goal)->what + ": " + operator_.report(goal)->reason, logs_of(follower));
  strike(cell);
  // It docks, or gives up; both are well.
  wait_until(over, dock_timeout_s, [] { return "the docking neither succeeds nor ends"; });
  if (operator_.report(goal)->progress == GoalProgress::succeeded) {
    agree(2);
    undock_all();
  }
  wait_until_apart();
  go_home();
}

void ChaosFlight::wait_until_apart() {
  const auto idle = [&] {
    return std::all_of(ids_.begin(), ids_.end(), [&](std::uint32_t id) {
      const KnownModule* module = operator_.fleet().find(id);
      return module != nullptr && !module->in_chain() && module->docking &&
             module->docking->phase == msg::DockingPhase::idle;
    });
  };
  wait_until(idle, apart_timeout_s, [] { return "a docking is not over"; });
}

void ChaosFlight::take_places() {
  place_m_.clear();
  chain_before_.clear();
  for (const auto& ear : ears_) {
    place_m_.push_back(ear->truth() ? ear->truth()->p_WM_m : std::array<double, 3>{});
    const msg::ChainView* view = view_of(ear->id());
    chain_before_.push_back(view != nullptr ? view->members.size() : 0);
  }
}

void ChaosFlight::look(ChaosOutcome& outcome) {
  pump();
  for (std::size_t k = 0; k < ears_.size(); ++k) {
    if (!ears_[k]->truth()) continue;
    const std::array<double, 3>& p = ears_[k]->truth()->p_WM_m;
    outcome.height_m_min = std::min(outcome.height_m_min, p[2]);
    outcome.deviation_m_max = std::max(outcome.deviation_m_max, distance(p, place_m_[k]));
  }
}

bool ChaosFlight::role_filled(const ChaosCell& cell, Duration since) const {
  const pid_t pid = injector_.pid_of(cell);
  if (pid == 0 || (cell.kind != FaultKind::hang && pid == injector_.struck())) return false;
  const DemoEar& ear = *ears_[cell.module_id - 1];
  return std::any_of(ear.heartbeats().begin(), ear.heartbeats().end(), [&](const auto& beat) {
    return static_cast<pid_t>(beat.second.pid) == pid && monotonic_now() - ear.heartbeat_age(beat.first) > since;
  });
}

bool ChaosFlight::all_heard() const {
  return std::all_of(ids_.begin(), ids_.end(), [&](std::uint32_t id) {
    const KnownModule* module = operator_.fleet().find(id);
    return module != nullptr && module->state &&
           to_s(operator_.module_now() - from_ns(module->state->stamp_ns)) < heard_s;
  });
}

bool ChaosFlight::all_at_place() const {
  for (std::size_t k = 0; k < ears_.size(); ++k) {
    if (!ears_[k]->truth() || distance(ears_[k]->truth()->p_WM_m, place_m_[k]) > bounds_.place_m) return false;
  }
  return true;
}

bool ChaosFlight::flying_as_before() const {
  for (std::size_t k = 0; k < ears_.size(); ++k) {
    const auto mode = ears_[k]->flight_mode();
    if (!mode || *mode == msg::FlightMode::disarmed || *mode == msg::FlightMode::failsafe ||
        *mode == msg::FlightMode::stopped) {
      return false;
    }
    const msg::ChainView* view = view_of(ears_[k]->id());
    if (view == nullptr || view->members.size() != chain_before_[k]) return false;
  }
  return true;
}

void ChaosFlight::strike(const ChaosCell& cell) {
  take_places();
  ended_.clear();
  const bool process = strikes_a_process(cell.kind), approach = cell.stage == FlightStage::approach;
  ChaosOutcome outcome{.cell = cell, .vendor = plan_.dds, .height_m_min = 1e9};
  striking_ = &cell;
  const Duration begun = monotonic_now();
  if (const Status struck = injector_.begin(cell); !struck) fail(struck.error().message);
  while (monotonic_now() - begun < cell.lasts()) look(outcome);
  if (const Status undone = injector_.end(cell); !undone) fail(undone.error().message);
  const Duration over = monotonic_now();
  const auto since_s = [&] { return to_s(monotonic_now() - over); };
  const auto back = [&] {
    return process                           ? role_filled(cell, over)
           : cell.kind == FaultKind::address ? role_filled(cell, over) && all_heard()
                                             : all_heard();
  };
  const double back_s_max = process ? bounds_.back_s : bounds_.heal_s;
  while (!back() && since_s() < 3 * back_s_max) look(outcome);
  outcome.back_s = since_s();
  if (outcome.back_s > back_s_max)
    outcome.broken.push_back((process ? "not back in its role within " : "not all heard within ") +
                             std::to_string(back_s_max) + " s");
  while (since_s() < look_on_s) look(outcome);
  if (!approach) {
    const auto well = [&] { return all_at_place() && flying_as_before(); };
    while (!well() && since_s() < bounds_.place_within_s) look(outcome);
    outcome.settled_s = since_s();
    if (!well()) outcome.broken.push_back(all_at_place() ? "not flying as before" : "not at their places");
  }
  striking_ = nullptr;
  if (outcome.height_m_min < bounds_.height_m_min) outcome.broken.push_back("a module fell");
  for (const std::string& end : ended_) outcome.broken.push_back(end);
  outcomes_.push_back(outcome);
}

}  // namespace eciton::deploy
