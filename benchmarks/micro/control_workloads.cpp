// The whole control step as the service does it: the module's state taken (and, at 100 Hz, the rotors'), reference,
// pose control, allocation, the rotor command written; alone in hover, and third of a chain.
#include <array>
#include <memory>
#include <vector>

#include "benchmarks/micro/workload.hpp"
#include "core/base/result.hpp"
#include "core/bus/reader.hpp"
#include "core/bus/writer.hpp"
#include "idl/topics.hpp"
#include "services/control/control_service.hpp"

namespace eciton::bench {
namespace {

bus::ParticipantConfig ring_config() {
  bus::ParticipantConfig out;
  out.vendor = "mirror";
  out.domain = 11;
  return out;
}

control::ControlConfig control_config() {
  control::ControlConfig out;
  out.module_id = 1;
  return out;
}

/// Composed layout: all services of the module share the participant. The module stands still in the air.
class Flight {
 public:
  Flight() {
    ring_.set_all_wake(false);
    for (int k = 0; k < 500; ++k) step();
    mode_.write({.module_id = 1, .stamp_ns = to_ns(now_), .correlation_id = 1, .action = msg::ModeAction::arm});
    for (int k = 0; k < 500; ++k) step();
    msg::FlightGoal goal{.module_id = 1, .stamp_ns = to_ns(now_), .correlation_id = 2};
    goal.action = msg::FlightAction::takeoff;
    goal.p_WM_m[2] = 1;
    goal_.write(goal);
    for (int k = 0; k < 5000; ++k) step();
    if (thrust_N_ < 5) throw BadInput{{"control step: the module does not take off"}};
  }

  double step() {
    now_ += 2ms;
    ring_.set_now(now_);
    state_.write(state_of(1));
    if (++steps_ % 5 == 0) rotor_state_.write({.module_id = 1, .stamp_ns = to_ns(now_), .armed = armed_});
    control_.step(now_);
    while (const auto command = rotors_.take()) {
      armed_ = command->value.armed;
      thrust_N_ = command->value.rotors.empty() ? 0 : command->value.rotors[0].thrust_N;
    }
    return thrust_N_;
  }

  /// In the chain others' states come at 50 Hz, contact wrenches at 100 Hz.
  double step_in_chain() {
    if (steps_ % 5 == 0) contact_.write(contact_wrench());
    if (steps_ % 10 == 0) {
      state_.write(state_of(2));
      state_.write(state_of(3));
    }
    return step();
  }

  void form_chain() {
    for (const std::uint32_t id : {2u, 3u}) state_.write(state_of(id));
    msg::ChainView view{.module_id = 1, .stamp_ns = to_ns(now_), .incarnation = 1, .sequence_number = 1};
    view.epoch = view.active_epoch = epoch;
    view.phase = msg::ViewPhase::active;
    view.active = true;
    view.base_id = 2;
    for (const std::uint32_t id : {3u, 2u, 1u}) view.members.push_back(id);
    view_.write(view);
    for (int k = 0; k < 1000; ++k) step_in_chain();
  }

 private:
  static constexpr std::uint64_t epoch = 77;

  msg::ModuleState state_of(std::uint32_t id) const {
    msg::ModuleState out{.module_id = id, .stamp_ns = to_ns(now_), .mode = msg::EstimatorMode::ready};
    out.p_WM_m = {0.8 * (id - 1.0), 0, 1};
    out.q_WM = {1, 0, 0, 0};
    return out;
  }

  msg::ContactWrench contact_wrench() const {
    msg::ContactWrench out{.module_id = 1, .stamp_ns = to_ns(now_), .epoch = epoch, .fresh = 3};
    for (const std::uint32_t id : {3u, 2u, 1u}) {
      msg::MemberWrench member{.module_id = id};
      member.r_W_m = {0.8 * (id - 1.0), 0, 1};
      member.link_W_m = {0.8 * (id - 1.5), 0, 1};
      member.d_force_W_N = {0.01 * (id - 2.0), 0, 0};
      out.members.push_back(member);
    }
    return out;
  }

  bus::Participant ring_{ring_config()};
  control::ControlService control_{ring_, control_config(), robot::legion()};
  bus::Writer<msg::ModuleState> state_ = ring_.create_writer(topics::module_state);
  bus::Writer<msg::RotorState> rotor_state_ = ring_.create_writer(topics::rotor_state);
  bus::Writer<msg::ModeRequest> mode_ = ring_.create_writer(topics::mode_request);
  bus::Writer<msg::FlightGoal> goal_ = ring_.create_writer(topics::flight_goal);
  bus::Writer<msg::ChainView> view_ = ring_.create_writer(topics::chain_view);
  bus::Writer<msg::ContactWrench> contact_ = ring_.create_writer(topics::contact_wrench);
  bus::Reader<msg::RotorCommand> rotors_ = ring_.create_reader(topics::rotor_command);
  TimePoint now_{1s};
  bool armed_ = false;
  double thrust_N_ = 0;
  int steps_ = 0;
};

Step alone() {
  auto flight = std::make_shared<Flight>();
  return [flight] { return flight->step(); };
}

Step in_chain() {
  auto flight = std::make_shared<Flight>();
  flight->form_chain();
  return [flight] { return flight->step_in_chain(); };
}

}  // namespace

std::vector<Workload> control_workloads() {
  return {{"control/step_in_hover", alone, true}, {"control/step_in_chain_of_3", in_chain, true}};
}

}  // namespace eciton::bench
