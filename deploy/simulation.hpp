// A whole fleet in one process: every module's hardware host and services over a simulated network, the
// world behind them, in virtual time. The experiments and scenario tests run in it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/bus/vendors/sim_network/sim_network.hpp"
#include "core/runtime/sim_executor.hpp"
#include "deploy/module.hpp"
#include "hal/sim/world.hpp"

namespace eciton::deploy {

/// The swarm ring's radio in simulation.
struct RadioLinkConfig {
  double delay_s = 0.010;
  double jitter_s = 0.003;
  double loss = 0.05;
  double duplication = 0;
  double reordering = 0;

  template <class V>
  void visit_fields(V& v) {
    v("delay_s", delay_s, in_range(0, 1));
    v("jitter_s", jitter_s, in_range(0, 1));
    v("loss", loss, in_range(0, 1));
    v("duplication", duplication, in_range(0, 1));
    v("reordering", reordering, in_range(0, 1));
  }
};

struct SimulationConfig {
  hal::sim::WorldConfig world;
  RadioLinkConfig radio_link;
  ModuleConfig module;                     // of every module, but for its id
  std::vector<std::uint32_t> mute_claims;  // an experiment's control: these never publish their link claims
};

class Simulation {
 public:
  explicit Simulation(const SimulationConfig& config);
  ~Simulation();

  hal::sim::World& world() { return *world_; }
  runtime::SimExecutor& executor() { return *executor_; }
  /// The operators' participant on the swarm ring.
  bus::Participant& operators() { return *operators_; }
  /// A participant that listens on a module's ring and writes nothing: what the services believe.
  bus::Participant& listener(std::size_t module);
  /// As if a service's process hung: it steps no more.
  void suspend(std::size_t module, const std::string& service);
  /// As if its process were killed; what its checkpoint holds is left.
  void kill(std::size_t module, const std::string& service);
  /// As if its supervisor started it again, with what the kill left, or without. Each service once.
  void restart(std::size_t module, const std::string& service, bool from_checkpoint = true);
  /// Starts a running service anew with its config changed, from its checkpoint: as an operator does who edits the
  /// file. Each service once.
  void replace(std::size_t module, const std::string& service, const std::function<void(ModuleConfig&)>& change);
  /// Nobody hears anybody on the swarm ring, until it is false.
  void silence_swarm(bool silent);
  bus::sim_network::Network& swarm() { return bus::sim_network::Network::of(config_.module.swarm_ring.domain); }
  std::size_t size() const { return config_.world.modules.size(); }
  std::uint32_t id(std::size_t module) const { return config_.world.modules[module].id; }
  TimePoint now() const { return executor_->now(); }
  double elapsed_s() const { return to_s(now() - start_); }

 private:
  struct SimulatedModule;
  void add_module(std::uint32_t id);

  SimulationConfig config_;
  TimePoint start_;
  std::unique_ptr<hal::sim::World> world_;
  std::unique_ptr<runtime::Plant> wired_;  // the world with every module's board
  std::vector<std::unique_ptr<SimulatedModule>> modules_;
  std::unique_ptr<runtime::SimExecutor> executor_;
  std::unique_ptr<bus::Participant> operators_;
};

}  // namespace eciton::deploy
