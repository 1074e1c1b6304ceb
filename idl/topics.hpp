// Every topic of Eciton: name, type, class of service, scope, deadline, lifespan. A new topic is a struct
// in an .idl file and a line here, with a reason. What each carries is in docs/architecture.md.
#pragma once

#include <tuple>

#include "core/bus/topic.hpp"
#include "idl/all.hpp"

namespace eciton::topics {

using bus::QosClass;
using bus::Scope;
using bus::Topic;
using namespace std::chrono_literals;

// Lockstep
inline constexpr Topic<msg::Clock> clock{"clock", QosClass::command, Scope::module};
inline constexpr Topic<msg::ClockAck> clock_ack{"clock_ack", QosClass::command, Scope::module};

// Sensing and state
inline constexpr Topic<msg::Imu> imu{"imu", QosClass::sensor, Scope::module, 10ms, 100ms};
inline constexpr Topic<msg::PoseMeasurement> pose_measurement{"pose_measurement", QosClass::sensor, Scope::module,
                                                              200ms, 500ms};
inline constexpr Topic<msg::ModuleState> module_state{"module_state", QosClass::sensor, Scope::swarm, 10ms, 1s};

// Wrenches
inline constexpr Topic<msg::ExternalWrench> external_wrench{"external_wrench", QosClass::sensor, Scope::swarm, 50ms,
                                                            1s};
inline constexpr Topic<msg::ContactWrench> contact_wrench{"contact_wrench", QosClass::sensor, Scope::module, 50ms,
                                                          200ms};
inline constexpr Topic<msg::ModelErrors> model_errors{"model_errors", QosClass::state, Scope::module};

// Actuators
inline constexpr Topic<msg::RotorCommand> rotor_command{"rotor_command", QosClass::sensor, Scope::module, 20ms, 50ms};
inline constexpr Topic<msg::RotorState> rotor_state{"rotor_state", QosClass::sensor, Scope::module, 50ms, 200ms};
inline constexpr Topic<msg::JointCommand> joint_command{"joint_command", QosClass::command, Scope::module};
inline constexpr Topic<msg::JointState> joint_state{"joint_state", QosClass::sensor, Scope::swarm, 50ms, 1s};
inline constexpr Topic<msg::LatchCommand> latch_command{"latch_command", QosClass::command, Scope::module};
inline constexpr Topic<msg::LatchState> latch_state{"latch_state", QosClass::state, Scope::module};

// Goals
inline constexpr Topic<msg::FlightGoal> flight_goal{"flight_goal", QosClass::command, Scope::swarm};
inline constexpr Topic<msg::PathGoal> path_goal{"path_goal", QosClass::command, Scope::swarm};
inline constexpr Topic<msg::MorphGoal> morph_goal{"morph_goal", QosClass::command, Scope::swarm};
inline constexpr Topic<msg::ContactGoal> contact_goal{"contact_goal", QosClass::command, Scope::swarm};
inline constexpr Topic<msg::DockGoal> dock_goal{"dock_goal", QosClass::command, Scope::swarm};
inline constexpr Topic<msg::ModeRequest> mode_request{"mode_request", QosClass::command, Scope::swarm};
inline constexpr Topic<msg::GoalStatus> goal_status{"goal_status", QosClass::state, Scope::swarm};

// Docking and chains
inline constexpr Topic<msg::DockingState> docking_state{"docking_state", QosClass::state, Scope::swarm};
inline constexpr Topic<msg::DockingReference> docking_reference{"docking_reference", QosClass::sensor, Scope::swarm,
                                                                50ms, 500ms};
inline constexpr Topic<msg::BaseReference> base_reference{"base_reference", QosClass::sensor, Scope::swarm, 200ms,
                                                          1s};
inline constexpr Topic<msg::LinkClaim> link_claim{"link_claim", QosClass::state, Scope::swarm};
inline constexpr Topic<msg::ChainView> chain_view{"chain_view", QosClass::state, Scope::swarm};

// The fleet
inline constexpr Topic<msg::Beacon> beacon{"beacon", QosClass::sensor, Scope::swarm, 6s};
inline constexpr Topic<msg::ModuleInfo> module_info{"module_info", QosClass::state, Scope::swarm};
inline constexpr Topic<msg::RadioState> radio_state{"radio_state", QosClass::sensor, Scope::module, 6s};
inline constexpr Topic<msg::Heartbeat> heartbeat{"heartbeat", QosClass::sensor, Scope::module, 50ms};
inline constexpr Topic<msg::Event> event{"event", QosClass::event, Scope::swarm};
inline constexpr Topic<msg::Fault> fault{"fault", QosClass::event, Scope::swarm};

// Simulation's truth
inline constexpr Topic<msg::TruthPose> truth_pose{"truth_pose", QosClass::sensor, Scope::module};
inline constexpr Topic<msg::TruthContact> truth_contact{"truth_contact", QosClass::sensor, Scope::module};

inline constexpr auto all =
    std::tuple{clock,          clock_ack,    imu,           pose_measurement, module_state,      external_wrench,
               contact_wrench, model_errors, rotor_command, rotor_state,      joint_command,     joint_state,
               latch_command,  latch_state,  flight_goal,   path_goal,        morph_goal,        contact_goal,
               dock_goal,      mode_request, goal_status,   docking_state,    docking_reference, base_reference,
               link_claim,     chain_view,   beacon,        module_info,      radio_state,       heartbeat,
               event,          fault,        truth_pose,    truth_contact};

/// Calls `visit(topic)` for each topic.
template <class Visit>
constexpr void for_each(Visit&& visit) {
  std::apply([&](const auto&... topic) { (visit(topic), ...); }, all);
}

}  // namespace eciton::topics
