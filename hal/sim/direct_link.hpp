// A module's board bound to a world in the same process: what the simulation executor uses.
#pragma once

#include "hal/sim/board.hpp"
#include "hal/sim/world.hpp"

namespace eciton::hal::sim {

class DirectLink {
 public:
  /// The world must outlive the link.
  DirectLink(World& world, std::uint32_t module) : world_(world), module_(module) {}

  Board& board() { return board_; }
  /// Copies the module's readings in. Real-time safe.
  void sense() { board_.set_sensors(world_.sense(module_)); }
  /// Copies the commands out. Real-time safe.
  void act() {
    board_.actuators().stamp = board_.sensors().stamp;
    world_.actuate(module_, board_.actuators());
  }

 private:
  World& world_;
  std::uint32_t module_;
  Board board_;
};

}  // namespace eciton::hal::sim
