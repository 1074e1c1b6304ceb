// What a demo listens to on the modules' rings: heartbeats, wrenches as the services believe them, and the
// truth from the world's observer; and the figures made from them.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/bus/participant.hpp"
#include "deploy/command/module_ear.hpp"
#include "deploy/operator/known_fleet.hpp"
#include "idl/topics.hpp"

namespace eciton::deploy {

struct Spread {
  std::size_t count = 0;
  double sum = 0;
  double max = 0;

  void add(double value) {
    ++count;
    sum += value;
    max = std::max(max, value);
  }
  double mean() const { return count == 0 ? 0 : sum / static_cast<double>(count); }
};

/// What the flight is about at a moment, so that figures are not mixed.
enum class DemoPhase { grounded, other, hovering, docking, assembled, morphing };

struct DemoFigures {
  std::map<DemoPhase, Spread> contact_force_N;  // the physics'
  std::map<DemoPhase, Spread> contact_moment_Nm;
  std::map<DemoPhase, Spread> contact_force_N_estimated;  // the services'
  Spread tracking_error_m;
  Spread estimation_error_m;
};

/// One module's.
class DemoEar {
 public:
  DemoEar(std::uint32_t id, const bus::ParticipantConfig& config);

  /// Takes what is there and adds it to the figures. `state`: as the swarm ring has it, may be null.
  void poll(DemoPhase phase, const msg::ModuleState* state, DemoFigures& figures);

  /// The module shall be here; nothing: its goal is not known.
  void set_goal(std::optional<std::array<double, 3>> goal_m) { goal_m_ = goal_m; }
  std::uint32_t id() const { return id_; }
  bus::Participant& participant() { return ring_; }
  const std::map<std::string, msg::Heartbeat>& heartbeats() const { return heartbeats_; }
  /// Since it was heard here; for ever when it never was.
  Duration heartbeat_age(const std::string& service) const;
  std::optional<msg::FlightMode> flight_mode() const;
  bool zeroed() const { return zeroed_; }
  bool latched() const { return latched_; }
  const std::optional<msg::TruthPose>& truth() const { return truth_; }

 private:
  std::uint32_t id_;
  bus::Participant ring_;
  bus::Reader<msg::Heartbeat> heartbeat_;
  bus::Reader<msg::ExternalWrench> external_wrench_;
  bus::Reader<msg::ContactWrench> contact_wrench_;
  bus::Reader<msg::TruthPose> truth_pose_;
  bus::Reader<msg::TruthContact> truth_contact_;

  std::map<std::string, msg::Heartbeat> heartbeats_;
  std::map<std::string, Duration> beat_heard_at_;
  std::optional<msg::TruthPose> truth_;
  std::optional<std::array<double, 3>> goal_m_;
  std::int64_t compared_ns_ = 0;
  bool zeroed_ = false;
  bool latched_ = false;
};

}  // namespace eciton::deploy
