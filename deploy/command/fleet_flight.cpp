// Watching while the flight goes on. The steps that all flights share are in fleet_steps.cpp.
#include "deploy/command/fleet_flight.hpp"

#include <cstdio>

#include "core/base/wall_clock.hpp"

namespace eciton::deploy {
namespace {

constexpr Duration pace = std::chrono::milliseconds(5);
constexpr Duration standstill_max = std::chrono::seconds(30);  // of the modules' clock, on the wall
constexpr Duration speed_window = std::chrono::seconds(1);
constexpr double wall_time_factor = 12;  // a slow machine or a slow vendor: simulated time lags so much at worst
constexpr std::size_t faults_kept = 12;

bus::ParticipantConfig participant(const DemoFleet& fleet, const std::string& name, std::uint32_t domain,
                                   const std::string& network_interface) {
  return {.vendor = fleet.tool_vendor,
          .domain = domain,
          .name = name,
          .network_interface = network_interface,
          .peers = {}};
}

/// With all its sockets and threads in the operator's host, if there is one.
bus::Participant join_swarm(const DemoFleet& fleet) {
  const net::InNamespace inside(fleet.swarm_namespace);
  return bus::Participant(participant(fleet, "demo", fleet.swarm_domain, fleet.swarm_interface));
}

}  // namespace

FleetFlight::FleetFlight(const DemoFleet& fleet, Launches& launches, const runtime::StopFlag& stop, DemoView& view)
    : fleet_(fleet),
      launches_(launches),
      stop_(stop),
      view_(view),
      swarm_(join_swarm(fleet)),
      operator_(swarm_),
      wall_begin_(monotonic_now()),
      fault_(swarm_.create_reader(topics::fault)),
      advanced_at_(wall_begin_),
      speed_wall_(wall_begin_) {
  for (const LaunchPlan& plan : fleet.plans) {
    if (plan.module_id == 0) continue;
    ids_.push_back(plan.module_id);
    const net::InNamespace inside(plan.network_namespace);
    ears_.push_back(
        std::make_unique<DemoEar>(plan.module_id, participant(fleet, "demo", plan.domain, plan.network_interface)));
  }
}

double FleetFlight::now_s() const { return time_begin_ ? to_s(operator_.module_now() - *time_begin_) : 0; }

void FleetFlight::begin(const std::string& step, DemoPhase phase) {
  step_ = step;
  phase_ = phase;
  view_.step(step, now_s());
}

void FleetFlight::fail(const std::string& why, std::set<std::string> processes) {
  throw FlightFailure{.step = step_, .why = why, .processes = std::move(processes)};
}

std::set<std::string> FleetFlight::logs_of(std::uint32_t id) const {
  std::set<std::string> logs;
  for (const LaunchPlan& plan : fleet_.plans) {
    if (plan.module_id != id) continue;
    for (const PlannedProcess& process : plan.processes) logs.insert(plan.name + "/" + process.name);
  }
  return logs;
}

const msg::ChainView* FleetFlight::view_of(std::uint32_t id) const {
  const KnownModule* module = operator_.fleet().find(id);
  return module != nullptr && module->view ? &*module->view : nullptr;
}

void FleetFlight::take_faults() {
  while (const auto fault = fault_.take()) {
    std::string line = "m" + std::to_string(fault->value.module_id) + "/" + fault->value.service.c_str();
    if (!fault->value.device.empty()) line += " (" + std::string(fault->value.device.view()) + ")";
    line += ": " + std::string(fault->value.text.view());
    if (!faults_.empty() && faults_.back() == line) continue;
    faults_.push_back(line);
    if (faults_.size() > faults_kept) faults_.erase(faults_.begin());
  }
}

void FleetFlight::on_end(Launch& launch, const ChildReport& report) {
  fail(describe(launch, report), {launch.plan().name + "/" + report.name, fleet_.plans[0].name + "/world"});
}

void FleetFlight::pump() {
  watch(launches_, {stop_.file_descriptor()}, pace,
        [&](Launch& launch, const ChildReport& report) { on_end(launch, report); });
  if (stop_.requested())
    throw FlightFailure{.step = step_, .why = "interrupted", .processes = {}, .interrupted = true};
  for (const auto& launch : launches_) {
    if (launch->stop_requested()) fail("'eciton down' asked for the end of " + launch->plan().name);
  }
  operator_.poll(wall_now());
  take_faults();
  for (const auto& ear : ears_) {
    const KnownModule* module = operator_.fleet().find(ear->id());
    ear->poll(phase_, module != nullptr && module->state ? &*module->state : nullptr, figures_);
  }
  const Duration now = monotonic_now();
  if (time_begin_ && operator_.module_now() > advanced_to_) {
    advanced_to_ = operator_.module_now();
    advanced_at_ = now;
  }
  if (time_begin_ && now - advanced_at_ > standstill_max) {
    fail("the modules' time stands still since " + std::to_string(now_s()) + " s", {fleet_.plans[0].name + "/world"});
  }
  draw(now);
}

void FleetFlight::draw(Duration monotonic) {
  if (monotonic - speed_wall_ > speed_window) {
    speed_factor_ = (now_s() - speed_simulated_s_) / to_s(monotonic - speed_wall_);
    speed_simulated_s_ = now_s();
    speed_wall_ = monotonic;
  }
  std::vector<DemoViewLine> lines;
  for (const auto& ear : ears_) {
    DemoViewLine line{.module = "m" + std::to_string(ear->id()),
                      .flight_mode = "-",
                      .docking = "-",
                      .gap = {},
                      .chain = "-",
                      .latched = ear->latched() ? "latched" : ""};
    if (const auto mode = ear->flight_mode()) line.flight_mode = name_of(*mode);
    if (const KnownModule* module = operator_.fleet().find(ear->id())) {
      if (module->docking) {
        const msg::DockingState& docking = *module->docking;
        line.docking = name_of(docking.phase);
        char gap[48];
        std::snprintf(gap, sizeof gap, "gap %.3f m", docking.axial_gap_m);
        if (docking.role == msg::DockingRole::follower && docking.phase != msg::DockingPhase::idle) line.gap = gap;
      }
      if (module->in_chain()) {
        line.chain = "chain ";
        for (std::size_t k = 0; k < module->view->members.size(); ++k) {
          line.chain += (k == 0 ? "" : "-") + std::to_string(module->view->members[k]);
        }
      } else if (module->view) {
        line.chain = "alone";
      }
    }
    lines.push_back(line);
  }
  view_.refresh(now_s(), speed_factor_, lines, monotonic);
}

void FleetFlight::wait_until(const std::function<bool()>& done, double timeout_s,
                             const std::function<std::string()>& lacks) {
  const double begin_s = now_s();
  const Duration wall_begin = monotonic_now();
  while (!done()) {
    pump();
    const double waited_s = to_s(monotonic_now() - wall_begin);
    if (now_s() - begin_s > timeout_s || waited_s > wall_time_factor * timeout_s + 10) {
      char text[96];
      std::snprintf(text, sizeof text, "not done after %.1f s of flight, %.1f s here: ", now_s() - begin_s, waited_s);
      fail(text + lacks());
    }
  }
}

void FleetFlight::hover(double seconds) {
  const double end_s = now_s() + seconds;
  wait_until([&] { return now_s() >= end_s; }, seconds + 5, [] { return "the time does not pass"; });
}

void FleetFlight::follow(const Goals& goals, double timeout_s) {
  const auto done = [&](std::uint64_t goal) { return is_over(operator_.report(goal)->progress); };
  const auto lacks = [&] {
    std::string text;
    for (const std::uint64_t goal : goals) {
      const GoalReport& report = *operator_.report(goal);
      if (done(goal)) continue;
      text += (text.empty() ? "" : "; ") + report.what + " is " + std::string(to_string(report.progress));
      if (!report.reason.empty()) text += ": " + report.reason;
    }
    return text;
  };
  wait_until([&] { return std::all_of(goals.begin(), goals.end(), done); }, timeout_s, lacks);
}

void FleetFlight::finish(const Goals& goals, double timeout_s) {
  follow(goals, timeout_s);
  for (const std::uint64_t goal : goals) {
    const GoalReport& report = *operator_.report(goal);
    if (report.progress == GoalProgress::succeeded) continue;
    fail(report.what + " was " + std::string(to_string(report.progress)) + ": " + report.reason,
         logs_of(report.module_id));
  }
}

}  // namespace eciton::deploy
