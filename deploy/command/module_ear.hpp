// Listens on one module's ring: the newest heartbeat of each service, the module's states, and its last faults.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>

#include "core/bus/participant.hpp"
#include "idl/topics.hpp"

namespace eciton::deploy {

struct HeardHeartbeat {
  msg::Heartbeat beat;
  Duration arrived{};  // on the monotonic clock
};

class ModuleEar {
 public:
  static constexpr std::size_t faults_kept = 5;

  explicit ModuleEar(const bus::ParticipantConfig& config);

  /// Takes what is there.
  void poll();

  bus::Participant& participant() { return participant_; }
  const std::map<std::string, HeardHeartbeat>& heartbeats() const { return heartbeats_; }
  const std::optional<msg::ModuleState>& state() const { return state_; }
  const std::optional<msg::DockingState>& docking() const { return docking_; }
  const std::optional<msg::ChainView>& view() const { return view_; }
  const std::optional<msg::RadioState>& radio() const { return radio_; }
  /// The last ones, in the order of their stamps.
  const std::deque<msg::Fault>& faults() const { return faults_; }
  /// Of severity error, the kept ones and those before, as far back as their writers keep them.
  std::size_t errors() const { return errors_; }
  /// By the module's own clock, as its newest heartbeat has it.
  Duration age_of(std::int64_t stamp_ns) const;
  /// As control says in its heartbeat.
  std::optional<msg::FlightMode> flight_mode() const;

 private:
  bus::Participant participant_;
  bus::Reader<msg::Heartbeat> heartbeat_reader_;
  bus::Reader<msg::ModuleState> state_reader_;
  bus::Reader<msg::DockingState> docking_reader_;
  bus::Reader<msg::ChainView> view_reader_;
  bus::Reader<msg::RadioState> radio_reader_;
  bus::Reader<msg::Fault> fault_reader_;
  std::map<std::string, HeardHeartbeat> heartbeats_;
  std::optional<msg::ModuleState> state_;
  std::optional<msg::DockingState> docking_;
  std::optional<msg::ChainView> view_;
  std::optional<msg::RadioState> radio_;
  std::deque<msg::Fault> faults_;
  std::size_t errors_ = 0;
};

/// The IDL's name of an enumerator.
template <class E>
std::string name_of(E value) {
  return std::string(bus::EnumTraits<E>::names[static_cast<std::size_t>(value)]);
}

}  // namespace eciton::deploy
