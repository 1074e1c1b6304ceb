// Latches, magnets and welds: which male port sits in which female port, and what pulls there.
// Called once per physics step, after the kinematics and before the forces are summed.
#pragma once

#include <optional>
#include <vector>

#include "hal/sim/model.hpp"

namespace eciton::hal::sim {

/// Force of contact in one link, from the physics.
struct LinkForce {
  robot::Vector3 p_W_m;      // the docking point: the male port's
  robot::Wrench wrench_P_W;  // of the male's module on the female's, about it, world axes
};

class Couplings {
 public:
  /// `weld_off`: latches report as ever, but hold nothing.
  Couplings(WorldModel& world, bool weld_off);

  /// A port's latch is told; `hold` changes nothing.
  void command(std::size_t port, LatchCommand command);
  /// Moves latches, magnets and captures on by one step; adds the magnets' pull to qfrc_applied (which the
  /// caller has cleared).
  void step();

  LatchReading reading(std::size_t port) const;
  /// The pair that holds this port; none when it is free.
  std::optional<std::size_t> pair_of(std::size_t port) const;
  /// Links held by a weld.
  int held() const { return held_; }
  /// Contact force in a pair, of the last completed step; zero when nothing holds it.
  LinkForce force(std::size_t pair);

  robot::Pose port_pose_W(std::size_t port) const;

 private:
  enum class Phase { open, capturing, held, parting };
  struct PortState {
    bool engaged = false;   // the latch is commanded to hold
    bool reports = false;   // its switch says latched
    bool occupied = false;  // by a weld, or by one just opened whose parts have not yet left each other
    std::size_t pair = 0;   // valid when occupied
    robot::Pose X_WP;
  };
  struct PairState {
    Phase phase = Phase::open;
    int steps = 0;     // since the capture began
    robot::Pose X_AB;  // of the female's link in the male's, at that moment
  };

  void step_open(std::size_t pair);
  void step_capture(std::size_t pair);
  void pull(const PairIndex& pair);
  bool seated(const PairIndex& pair) const;
  void close(std::size_t pair);
  void open(std::size_t pair);
  void set_contact(std::size_t port, bool on);
  void write_weld(std::size_t pair, double share);
  robot::Pose body_pose(int body) const;

  WorldModel& world_;
  bool weld_off_;
  int held_ = 0;
  std::vector<PortState> ports_;
  std::vector<PairState> pairs_;
  std::vector<int> contype_, conaffinity_;       // of all geoms, as the model has them
  std::vector<double> row_force_, joint_force_;  // scratch of force() and pull()
};

}  // namespace eciton::hal::sim
