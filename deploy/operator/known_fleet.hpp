// What a participant of the swarm ring hears of each module, and what time it is there.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/bus/participant.hpp"
#include "idl/topics.hpp"

namespace eciton::deploy {

struct KnownModule {
  TimePoint first_heard;  // on the caller's clock
  TimePoint heard;
  std::optional<msg::ModuleState> state;
  std::optional<msg::ChainView> view;
  std::optional<msg::DockingState> docking;
  std::optional<msg::Beacon> beacon;

  /// Flies as a member of a chain of more than itself.
  bool in_chain() const { return view && view->active && view->active_epoch != 0 && view->members.size() > 1; }
  /// The view it announces is the one it flies by: nothing is being agreed on.
  bool settled() const { return view && view->epoch == view->active_epoch; }
};

class KnownFleet {
 public:
  explicit KnownFleet(bus::Participant& swarm);

  /// Takes what has arrived; `now` is the caller's clock, whichever that is.
  void poll(TimePoint now);

  const std::map<std::uint32_t, KnownModule>& modules() const { return modules_; }
  /// Nothing when it was never heard.
  const KnownModule* find(std::uint32_t id) const;
  /// "1, 2, 5", "none"
  std::string heard() const;

  /// The modules' time, for stamps. In simulated time it is the newest stamp heard, which differs from the
  /// caller's clock by more than a second; else it is the caller's clock.
  TimePoint module_now() const { return module_now_; }
  bool simulated_time() const { return simulated_time_; }
  /// Before a state or a beacon was heard the modules' time is only supposed to be the caller's.
  bool time_known() const { return time_known_; }

 private:
  KnownModule& note(std::uint32_t id);
  template <class T>
  void take(bus::Reader<T>& reader, std::optional<T> KnownModule::*member);

  bus::Participant& swarm_;
  TimePoint now_{};
  TimePoint module_now_{};
  bool time_known_ = false;
  bool simulated_time_ = false;
  std::map<std::uint32_t, KnownModule> modules_;
  bus::Reader<msg::ModuleState> state_;
  bus::Reader<msg::ChainView> view_;
  bus::Reader<msg::DockingState> docking_;
  bus::Reader<msg::Beacon> beacon_;
};

}  // namespace eciton::deploy
