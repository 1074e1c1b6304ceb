// Makes a module's services and hardware from its config; the one place that knows them all by name.
#pragma once

#include <memory>
#include <string>

#include "core/runtime/service.hpp"
#include "deploy/module_config.hpp"
#include "hal/host/act_service.hpp"
#include "hal/host/sense_service.hpp"

namespace eciton::deploy {

robot::Airframe make_airframe(const ModuleConfig& config);

/// `name` is one of service_names; `swarm` is used by the radio alone. Throws BadInput on another name.
std::unique_ptr<runtime::Service> make_service(const std::string& name, const ModuleConfig& config,
                                               bus::Participant& ring, bus::Participant* swarm);

/// Configures all devices and powers what may always be powered: joints and latches, not rotors. Throws BadInput.
void bring_up(hal::Devices& devices);

/// Larger at every start of the module: the wall clock, unless simulated time says otherwise.
std::uint64_t incarnation_at(TimePoint start);

}  // namespace eciton::deploy
