// Who meets the services where they meet: one that listens to their commands, and one that has them fly.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/path/path_trace.hpp"
#include "core/bus/participant.hpp"
#include "core/bus/reader.hpp"
#include "core/bus/writer.hpp"
#include "idl/topics.hpp"

namespace eciton::bench {

/// Listens to rotor commands; used by the tap's thread alone.
class RingObserver {
 public:
  RingObserver(const bus::ParticipantConfig& config, std::size_t commands_max);

  /// Real-time safe. Often enough, since a reader holds only the newest.
  void poll();
  const std::vector<CommandSeen>& seen() const { return seen_; }

 private:
  bus::Participant ring_;
  bus::Reader<msg::RotorCommand> commands_;
  std::vector<CommandSeen> seen_;
};

/// Arms and takes off.
class Pilot {
 public:
  Pilot(const bus::ParticipantConfig& config, std::uint32_t module_id);

  void poll();
  bool alive(const std::string& service) const { return beats_.count(service) > 0; }
  bool hovers() const;
  /// Asks again until it is granted: the estimator needs a moment.
  void take_off(Duration now);
  std::string last_answer() const { return answer_ ? std::string(answer_->reason.view()) : "no answer"; }
  /// The last one of each service.
  std::vector<msg::Heartbeat> heartbeats() const;

 private:
  void arm();
  void ask_for_takeoff();

  bus::Participant ring_;
  std::uint32_t module_id_;
  std::map<std::string, msg::Heartbeat> beats_;
  std::optional<msg::GoalStatus> answer_;
  std::uint64_t correlation_ = 0;
  Duration ask_due_{};
  bus::Reader<msg::Heartbeat> heartbeat_;
  bus::Reader<msg::GoalStatus> status_;
  bus::Writer<msg::ModeRequest> mode_;
  bus::Writer<msg::FlightGoal> goal_;
};

}  // namespace eciton::bench
