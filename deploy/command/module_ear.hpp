// Listens on one module's ring: the newest heartbeat of each service, and the module's states.
#pragma once

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
  explicit ModuleEar(const bus::ParticipantConfig& config);

  /// Takes what is there.
  void poll();

  bus::Participant& participant() { return participant_; }
  const std::map<std::string, HeardHeartbeat>& heartbeats() const { return heartbeats_; }
  const std::optional<msg::ModuleState>& state() const { return state_; }
  const std::optional<msg::DockingState>& docking() const { return docking_; }
  const std::optional<msg::ChainView>& view() const { return view_; }
  /// As control says in its heartbeat.
  std::optional<msg::FlightMode> flight_mode() const;

 private:
  bus::Participant participant_;
  bus::Reader<msg::Heartbeat> heartbeat_reader_;
  bus::Reader<msg::ModuleState> state_reader_;
  bus::Reader<msg::DockingState> docking_reader_;
  bus::Reader<msg::ChainView> view_reader_;
  std::map<std::string, HeardHeartbeat> heartbeats_;
  std::optional<msg::ModuleState> state_;
  std::optional<msg::DockingState> docking_;
  std::optional<msg::ChainView> view_;
};

/// The IDL's name of an enumerator.
template <class E>
std::string name_of(E value) {
  return std::string(bus::EnumTraits<E>::names[static_cast<std::size_t>(value)]);
}

}  // namespace eciton::deploy
