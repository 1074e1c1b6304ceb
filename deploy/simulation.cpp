// Puts a fleet together in one process.
#include "deploy/simulation.hpp"

#include <algorithm>
#include <map>

#include "core/base/contract.hpp"
#include "hal/sim/direct_link.hpp"
#include "hal/sim/make_devices.hpp"

namespace eciton::deploy {
namespace {

using bus::sim_network::LinkQuality;
using bus::sim_network::Network;
using bus::sim_network::Pacing;

/// Moves what the boards hold into the world, the world on, and its readings back.
class WiredWorld final : public runtime::Plant {
 public:
  explicit WiredWorld(hal::sim::World& world) : world_(world) {}
  void connect(hal::sim::DirectLink& link) {
    links_.push_back(&link);
    link.sense();
  }
  void advance(TimePoint until) override {
    for (hal::sim::DirectLink* link : links_) link->act();
    world_.advance(until);
    for (hal::sim::DirectLink* link : links_) link->sense();
  }

 private:
  hal::sim::World& world_;
  std::vector<hal::sim::DirectLink*> links_;
};

}  // namespace

/// One module: its boards and devices, its two participants, its hardware host and its services.
struct Simulation::SimulatedModule {
  SimulatedModule(const ModuleConfig& module_config, hal::sim::World& world, TimePoint start)
      : config(module_config),
        airframe(make_airframe(config)),
        link(world, config.id),
        devices(hal::sim::make_devices(link.board(), airframe, config.hal.battery_compensation)),
        ring(config.module_participant("services")),
        swarm(config.swarm_participant("radio"), &ring.waker()),
        listener(std::make_unique<bus::Participant>(config.module_participant("listener"))),
        sense(ring, {.module_id = config.id}, devices),
        act(ring, {.module_id = config.id, .recorder = config.recorder}, airframe, devices) {
    config.radio.incarnation = incarnation_at(start);
    config.docking.incarnation = incarnation_at(start);
    for (const std::string_view name : service_names) {
      services.push_back(make_service(std::string(name), config, ring, &swarm));
    }
  }

  ModuleConfig config;
  robot::Airframe airframe;
  hal::sim::DirectLink link;
  hal::Devices devices;
  bus::Participant ring;
  bus::Participant swarm;
  std::unique_ptr<bus::Participant> listener;
  hal::SenseService sense;
  hal::ActService act;
  std::vector<std::unique_ptr<runtime::Service>> services;
  std::map<std::string, std::vector<std::byte>> checkpoints;
  runtime::SimModule* runs = nullptr;

  /// What a service that was started again runs in: a process of its own.
  struct Process {
    Process(const ModuleConfig& module_config, const std::string& name)
        : ring(module_config.module_participant(name + " again")),
          swarm(module_config.swarm_participant(name + " again"), &ring.waker()) {}
    bus::Participant ring, swarm;
    std::unique_ptr<runtime::Service> service;
    runtime::SimModule* runs = nullptr;
  };
  std::vector<std::unique_ptr<Process>> restarted;

  runtime::Service& find(const std::string& name) {
    const auto found =
        std::find_if(services.begin(), services.end(), [&](const auto& s) { return s->name() == name; });
    ECITON_EXPECT(found != services.end(), "a service that this module has, and that was not killed before");
    return **found;
  }
};

Simulation::Simulation(const SimulationConfig& config) : config_(config) {
  config_.module.dds = "sim_network";
  config_.module.vendors.clear();
  start_ = from_ns(static_cast<std::int64_t>(config_.world.start_ns));
  world_ = std::make_unique<hal::sim::World>(config_.world, make_airframe(config_.module), config_.world.modules);
  wired_ = std::make_unique<WiredWorld>(*world_);

  Network::reset_all();
  const RadioLinkConfig& radio = config_.radio_link;
  Network& air = Network::of(config_.module.swarm_ring.domain);
  air.configure(config_.world.seed, Pacing::virtual_time);
  air.set_default_link({.delay = from_s(radio.delay_s),
                        .jitter = from_s(radio.jitter_s),
                        .loss = radio.loss,
                        .duplication = radio.duplication,
                        .reordering = radio.reordering});
  std::vector<Network*> networks{&air};
  for (const hal::sim::ModuleStart& start : config_.world.modules) {
    Network& ring = Network::of(module_ring_domain(start.id));
    ring.configure(config_.world.seed, Pacing::virtual_time);
    networks.push_back(&ring);
  }
  executor_ =
      std::make_unique<runtime::SimExecutor>(runtime::SimConfig{.start = start_}, *wired_, [networks](TimePoint now) {
        for (Network* network : networks) network->advance(now);
      });

  for (const hal::sim::ModuleStart& start : config_.world.modules) add_module(start.id);
  bus::ParticipantConfig participant = config_.module.swarm_participant("operators");
  participant.name = "operators";
  participant.vendor = "sim_network";
  operators_ = std::make_unique<bus::Participant>(participant);
  executor_->observe([this](TimePoint now) {
    operators_->set_now(now);
    for (auto& module : modules_) module->listener->set_now(now);
  });
}

Simulation::~Simulation() = default;

void Simulation::add_module(std::uint32_t id) {
  ModuleConfig config = config_.module;
  config.id = id;
  config.name = "m" + std::to_string(id);
  config.module_ring.domain = module_ring_domain(id);
  const auto& mute = config_.mute_claims;
  if (std::find(mute.begin(), mute.end(), id) != mute.end()) config.docking.claims_muted = true;
  if (!config.recorder.directory.empty()) config.recorder.directory += "/" + config.name;
  set_identity(config);
  auto module = std::make_unique<SimulatedModule>(config, *world_, start_);
  static_cast<WiredWorld&>(*wired_).connect(module->link);
  bring_up(module->devices);
  runtime::SimModule& runs =
      executor_->add_module({.module_id = id, .process = config.name}, {&module->ring, &module->swarm});
  runs.add(module->sense);
  for (auto& service : module->services) runs.add(*service);
  runs.add(module->act);
  module->runs = &runs;
  modules_.push_back(std::move(module));
}

void Simulation::suspend(std::size_t module, const std::string& service) {
  modules_[module]->runs->suspend(modules_[module]->find(service), true);
}

void Simulation::kill(std::size_t module, const std::string& service) {
  SimulatedModule& m = *modules_[module];
  runtime::Service& killed = m.find(service);
  runtime::StateWriter counting({});
  killed.save_state(counting);
  m.checkpoints[service].resize(counting.size());
  runtime::StateWriter writer(m.checkpoints[service]);
  killed.save_state(writer);
  m.runs->remove(killed);
  std::erase_if(m.services, [&](const auto& other) { return other->name() == service; });
}

void Simulation::restart(std::size_t module, const std::string& service, bool from_checkpoint) {
  SimulatedModule& m = *modules_[module];
  m.config.radio.incarnation = m.config.docking.incarnation = incarnation_at(now());
  auto process = std::make_unique<SimulatedModule::Process>(m.config, service);
  process->service = make_service(service, m.config, process->ring, &process->swarm);
  if (from_checkpoint) {
    runtime::StateReader reader(m.checkpoints[service]);
    process->service->load_state(reader);
  }
  process->runs =
      &executor_->add_module({.module_id = m.config.id, .process = service}, {&process->ring, &process->swarm});
  process->runs->add(*process->service);
  m.restarted.push_back(std::move(process));
}

void Simulation::replace(std::size_t module, const std::string& service,
                         const std::function<void(ModuleConfig&)>& change) {
  kill(module, service);
  change(modules_[module]->config);
  restart(module, service);
}

void Simulation::silence_swarm(bool silent) {
  if (!silent) {
    swarm().heal();
    return;
  }
  std::vector<std::vector<std::string>> alone;
  for (const auto& module : modules_) {
    alone.push_back({module->config.name + "/radio", module->config.name + "/radio again"});
  }
  swarm().partition(alone);
}

bus::Participant& Simulation::listener(std::size_t module) { return *modules_[module]->listener; }

}  // namespace eciton::deploy
