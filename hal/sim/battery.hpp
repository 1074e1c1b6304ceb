// A module's battery: its voltage falls with what was drawn from it, and sags under load.
#pragma once

#include <algorithm>

#include "hal/sim/world_config.hpp"

namespace eciton::hal::sim {

/// Load 1 is hovering; current goes with the power 3/2 of thrust. Pure.
class Battery {
 public:
  explicit Battery(const BatteryConfig& config) : config_(config), open_circuit_V_(config.start_V) {}

  void step(double load, double dt_s) {
    open_circuit_V_ -= config_.discharge_V_min / 60 * load * dt_s;
    voltage_V_ = std::max(open_circuit_V_ - config_.sag_V * load, empty_V);
  }
  double voltage_V() const { return voltage_V_; }

 private:
  static constexpr double empty_V = 18;  // and so it stays: what an empty battery does is not simulated
  BatteryConfig config_;
  double open_circuit_V_;
  double voltage_V_ = open_circuit_V_;
};

}  // namespace eciton::hal::sim
