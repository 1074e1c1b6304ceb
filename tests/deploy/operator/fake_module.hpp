// A module as an operator sees it: states and views on the swarm ring, answers to goals as a test likes.
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "core/bus/participant.hpp"
#include "core/bus/vendors/sim_network/sim_network.hpp"
#include "idl/topics.hpp"

namespace eciton::deploy {

class FakeModule {
 public:
  FakeModule(std::uint32_t id, const bus::ParticipantConfig& config)
      : id_(id),
        swarm_(config),
        state_(swarm_.create_writer(topics::module_state)),
        view_(swarm_.create_writer(topics::chain_view)),
        status_(swarm_.create_writer(topics::goal_status)),
        modes_(swarm_.create_reader(topics::mode_request)),
        flights_(swarm_.create_reader(topics::flight_goal)),
        morphs_(swarm_.create_reader(topics::morph_goal)),
        docks_(swarm_.create_reader(topics::dock_goal)) {}

  void announce(std::vector<std::uint32_t> members, std::uint64_t epoch) {
    msg::ChainView view{.module_id = id_, .epoch = epoch, .active_epoch = epoch, .active = true};
    for (const std::uint32_t member : members) view.members.push_back(member);
    view_.write(view);
  }
  void announce_agreeing(std::uint64_t epoch, std::uint64_t active_epoch) {
    view_.write({.module_id = id_, .epoch = epoch, .active_epoch = active_epoch, .active = true});
  }

  /// Publishes its state with this time and hears what has come.
  void step(TimePoint now) {
    state_.write({.module_id = id_, .stamp_ns = to_ns(now)});
    while (const auto m = modes_.take()) note(modes, m->value);
    while (const auto m = flights_.take()) note(flights, m->value);
    while (const auto m = morphs_.take()) note(morphs, m->value);
    while (const auto m = docks_.take()) note(docks, m->value);
  }

  void answer(msg::GoalKind kind, std::uint64_t correlation_id, msg::GoalPhase phase, std::string_view reason,
              TimePoint now) {
    status_.write({.module_id = id_,
                   .goal = kind,
                   .stamp_ns = to_ns(now),
                   .correlation_id = correlation_id,
                   .phase = phase,
                   .reason = reason});
  }

  std::vector<msg::ModeRequest> modes;  // those for this module, repetitions included
  std::vector<msg::FlightGoal> flights;
  std::vector<msg::MorphGoal> morphs;
  std::vector<msg::DockGoal> docks;

 private:
  template <class T>
  void note(std::vector<T>& list, const T& message) {
    if (message.module_id == id_) list.push_back(message);
  }

  std::uint32_t id_;
  bus::Participant swarm_;
  bus::Writer<msg::ModuleState> state_;
  bus::Writer<msg::ChainView> view_;
  bus::Writer<msg::GoalStatus> status_;
  bus::Reader<msg::ModeRequest> modes_;
  bus::Reader<msg::FlightGoal> flights_;
  bus::Reader<msg::MorphGoal> morphs_;
  bus::Reader<msg::DockGoal> docks_;
};

}  // namespace eciton::deploy
