// An operator on the swarm ring: sends goals to modules, again until they are answered, and follows what
// becomes of them. Never waits, so that it works in virtual time as well as behind a person's terminal.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/bus/participant.hpp"
#include "deploy/operator/known_fleet.hpp"
#include "idl/topics.hpp"

namespace eciton::deploy {

struct OperatorConfig {
  std::uint64_t first_correlation_id = 0;                    // 0: drawn from the clock and the process
  Duration resend = std::chrono::milliseconds(500);          // of what is not answered
  Duration stop_resend = std::chrono::milliseconds(50);      // of a stop
  Duration view_patience = std::chrono::milliseconds(500);   // for a module's chain view, once it is heard
  Duration match_patience = std::chrono::milliseconds(100);  // from our side's match to the other side's
  Duration chain_lead = std::chrono::milliseconds(300);      // members of a chain start together, so much later
};

enum class GoalProgress { unsent, unanswered, accepted, succeeded, refused, aborted };
std::string_view to_string(GoalProgress progress);
constexpr bool is_over(GoalProgress progress) { return progress >= GoalProgress::succeeded; }

struct GoalReport {
  std::uint64_t correlation_id = 0;
  std::uint32_t module_id = 0;
  msg::GoalKind kind{};
  std::string what;  // "dock 2 1"
  GoalProgress progress = GoalProgress::unsent;
  std::string reason;  // of a refusal or an abortion; or what an unsent goal waits for
  std::uint32_t sent = 0;
  TimePoint starts_at{};    // not before it: what the goal says, or when it was accepted
  TimePoint accepted_at{};  // by the module's stamps
  TimePoint ended_at{};
};

class Operator {
 public:
  explicit Operator(bus::Participant& swarm, const OperatorConfig& config = {});

  // Goals. Each returns its correlation id at once and goes out as soon as the module is heard.
  std::uint64_t arm(std::uint32_t id) { return mode(id, msg::ModeAction::arm); }
  std::uint64_t disarm(std::uint32_t id) { return mode(id, msg::ModeAction::disarm); }
  /// Measures the bias of the wrench observer anew.
  std::uint64_t zero(std::uint32_t id) { return mode(id, msg::ModeAction::zero); }
  /// Motors off at once: waits for nothing that is known of the module.
  std::uint64_t stop(std::uint32_t id) { return mode(id, msg::ModeAction::stop); }
  std::uint64_t take_off(std::uint32_t id, double height_m);
  /// In a chain: of the base, and the whole chain goes. `speed_m_s` 0: the module's default.
  std::uint64_t go_to(std::uint32_t id, const std::array<double, 3>& p_WM_m, double yaw_rad, double speed_m_s);
  /// Through poses to rest at the last one, at most 32; in a chain: of the base.
  std::uint64_t fly_path(std::uint32_t id, std::span<const msg::Waypoint> waypoints, double speed_m_s);
  std::uint64_t land(std::uint32_t id);
  std::uint64_t dock(std::uint32_t follower, std::uint32_t target);
  std::uint64_t undock(std::uint32_t id, std::uint32_t peer);
  /// Joint angles of the whole chain, member by member, yaw then pitch. `rate_rad_s` 0: the default.
  std::uint64_t morph(std::uint32_t id, std::span<const double> joint_position_rad, double rate_rad_s);

  /// Contact wrenches the chain shall keep, link by link in the axes of the member before it; none: all zero.
  std::uint64_t contact(std::uint32_t id, std::span<const msg::DesiredContact> links);

  /// Takes answers, sends what is due. `now`: the caller's clock, wall or virtual. Call it when the participant's
  /// waker is signalled and ten times a second or more.
  void poll(TimePoint now);

  /// The goal's state; nothing for an id this operator did not make.
  const GoalReport* report(std::uint64_t correlation_id) const;
  /// Ends following a goal: it is sent no more.
  void give_up(std::uint64_t correlation_id);
  const KnownFleet& fleet() const { return fleet_; }
  TimePoint module_now() const { return fleet_.module_now(); }

 private:
  using Message =
      std::variant<msg::ModeRequest, msg::FlightGoal, msg::PathGoal, msg::MorphGoal, msg::ContactGoal, msg::DockGoal>;
  struct Goal {
    GoalReport report;
    Message message;
    TimePoint matched_since{};
    bool matched = false;
    TimePoint send_at{};
    bool given_up = false;
  };

  std::uint64_t mode(std::uint32_t id, msg::ModeAction action);
  std::uint64_t add(msg::GoalKind kind, std::string what, Message message);
  void refuse(std::uint64_t correlation_id, const std::string& reason);
  void take_answers();
  bool is_chain_mate(std::uint32_t id, const Goal& goal) const;
  void answer(Goal& goal, const msg::GoalStatus& status);
  /// Whether the goal may go out; else notes what it waits for.
  bool ready(Goal& goal);
  bool fits_the_chain(Goal& goal, const KnownModule& module);
  void compose(Goal& goal, const KnownModule& module);
  void send(Goal& goal);
  auto& writer_of(const msg::ModeRequest&) { return mode_request_; }
  auto& writer_of(const msg::FlightGoal&) { return flight_goal_; }
  auto& writer_of(const msg::PathGoal&) { return path_goal_; }
  auto& writer_of(const msg::MorphGoal&) { return morph_goal_; }
  auto& writer_of(const msg::ContactGoal&) { return contact_goal_; }
  auto& writer_of(const msg::DockGoal&) { return dock_goal_; }

  OperatorConfig config_;
  KnownFleet fleet_;
  TimePoint now_{};
  std::uint64_t next_correlation_id_;
  std::map<std::uint64_t, Goal> goals_;
  bus::Writer<msg::ModeRequest> mode_request_;
  bus::Writer<msg::FlightGoal> flight_goal_;
  bus::Writer<msg::PathGoal> path_goal_;
  bus::Writer<msg::MorphGoal> morph_goal_;
  bus::Writer<msg::ContactGoal> contact_goal_;
  bus::Writer<msg::DockGoal> dock_goal_;
  bus::Reader<msg::GoalStatus> goal_status_;
};

}  // namespace eciton::deploy
