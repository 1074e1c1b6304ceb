// A module's parts from its config.
#include "deploy/module.hpp"

namespace eciton::deploy {

robot::Airframe make_airframe(const ModuleConfig& config) { return robot::legion(config.airframe == "legion-lidar"); }

void bring_up(hal::Devices& devices) {
  devices.for_each([](hal::Device& device) { ok_or_throw(device.configure()); });
  ok_or_throw(devices.joints->activate());
  for (auto& latch : devices.latches) ok_or_throw(latch->activate());
}

std::uint64_t incarnation_at(TimePoint start) { return static_cast<std::uint64_t>(to_ns(start)) + 1; }

std::unique_ptr<runtime::Service> make_service(const std::string& name, const ModuleConfig& config,
                                               bus::Participant& ring, bus::Participant* swarm) {
  const robot::Airframe airframe = make_airframe(config);
  if (name == "estimation") {
    return std::make_unique<estimation::EstimationService>(ring, config.estimation, airframe);
  }
  if (name == "control") return std::make_unique<control::ControlService>(ring, config.control, airframe);
  if (name == "docking") return std::make_unique<docking::DockingService>(ring, config.docking, airframe);
  if (name == "joints") return std::make_unique<joints::JointsService>(ring, config.joints, airframe);
  if (name == "radio" && swarm != nullptr) return std::make_unique<radio::RadioService>(ring, *swarm, config.radio);
  std::string known;
  for (const std::string_view service : service_names) known += (known.empty() ? "" : ", ") + std::string(service);
  throw BadInput{{"no service '" + name + "'; expected one of " + known}};
}

}  // namespace eciton::deploy
