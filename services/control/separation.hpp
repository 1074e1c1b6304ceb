// Keeps a module that flies apart at its distance from the others and inside the geofence. The nominal reference
// becomes one that gives way: barrier certificates for double integrators, each pair sharing what must be done
// (after Wang, Ames, Egerstedt, "Safety Barrier Certificates for Collisions-Free Multirobot Systems", 2017), and
// a rule of the road, pass with the other on your left, so that meetings of equals resolve themselves.
// With nothing in the way it is the nominal reference to the bit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/robot/trajectory.hpp"

namespace eciton::control {

/// A box in W that centres of mass stay in.
struct Fence {
  robot::Vector3 low_W{-50, -50, 0};
  robot::Vector3 high_W{50, 50, 30};

  bool holds(const robot::Vector3& p_W) const {
    return (p_W.array() >= low_W.array()).all() && (p_W.array() <= high_W.array()).all();
  }
};

/// Distances are between centres of mass. Around each module stands a cylinder: whoever is nearer than `height_m`
/// in height must keep `distance_m` level, for the wake below a rotor reaches far.
struct SeparationConfig {
  double distance_m = 1.25;  // of the references; 1.0 and what tracking errors, gusts and delays take of it
  double height_m = 1.5;
  double range_m = 3.0;    // further away nobody is looked at
  double speed_m_s = 0.8;  // while it gives way and catches up; faster only if the nominal reference is
  double acceleration_m_s2 = 2.0;
  double look_ahead_s = 2.0;    // of the rule of the road
  double rule_margin_m = 0.25;  // which passes at the distance and this
  // Where the rule leads round and round, as about a goal that others enclose, it is let go by and by, and a
  // little of the distance with it, so that those at rest make room; and then taken up again.
  double patience_s = 10;
  double impatient_s = 10;
  double pressing_m = 0.1;
  double tracking_error_m_max = 0.3;  // of this module: counts against its distance up to so much
  double silent_s = 0.3;              // a peer's state older than this: the distance grows ...
  double silence_growth_m_s = 0.4;    // ... at this rate ...
  double silence_margin_m_max = 0.8;  // ... up to this, about where it would be ...
  double extrapolate_s = 1.0;         // ... had it gone on so long
};

/// Another module as it was heard last; those this one docks with are left out.
struct Neighbour {
  robot::Vector3 p_WM = robot::Vector3::Zero();
  robot::Vector3 v_WM = robot::Vector3::Zero();
  double age_s = 0;
  bool gives_way = true;  // does its half; not in a chain, on the ground, or silent
};

struct SeparationInput {
  robot::PoseReference nominal;
  robot::Vector3 p_WM_ahead = robot::Vector3::Zero();  // where the nominal reference will be after `look_ahead_s`
  robot::Vector3 p_WM = robot::Vector3::Zero();        // where this module is
  std::span<const Neighbour> neighbours;               // no more than a chain has members
  Fence fence;
};

/// Real-time safe; one thread.
class Separation {
 public:
  explicit Separation(const SeparationConfig& config = {}) : config_(config) {}

  /// The reference to fly; the attitude passes through.
  robot::PoseReference update(const SeparationInput& input, double dt_s);
  /// The reference that is flown is not the nominal one.
  bool gives_way() const { return gives_way_; }
  /// Begins at the nominal reference again, wherever that is.
  void reset() { gives_way_ = false; }
  const SeparationConfig& config() const { return config_; }

  template <class Self, class V>
  static void visit_state(Self& self, V& v) {
    v(self.gives_way_, self.p_W_, self.v_W_, self.waiting_s_);
  }

 private:
  /// Keep n a >= least.
  struct Bound {
    robot::Vector3 n_W;
    double least_m_s2;
  };
  struct Bounds;
  /// A neighbour seen from the reference, now.
  struct Sight {
    robot::Vector3 away_W;  // level, or upright where it is kept off in height; unit
    robot::Vector3 p_W;
    robot::Vector3 v_W;
    double distance_m;
    double least_m;   // of the distance, for this pair
    double silent_m;  // on top of it, not to be entered but not fled from
    bool gives_way;
  };
  bool sees(const Neighbour& neighbour, const robot::Vector3& p_WM, Sight& sight) const;
  void bound(const Sight& sight, Bounds& bounds) const;
  void bound(const Fence& fence, Bounds& bounds) const;
  /// 0 to 1.
  double impatience() const;
  double turn_right(const Sight& sight, const robot::Vector3& wanted_v_W) const;
  robot::Vector3 wanted_velocity(const robot::PoseReference& nominal) const;

  SeparationConfig config_;
  bool gives_way_ = false;
  robot::Vector3 p_W_ = robot::Vector3::Zero();  // of the reference that is flown
  robot::Vector3 v_W_ = robot::Vector3::Zero();
  double waiting_s_ = 0;  // away from the nominal reference for so long
};

/// Speed from which one can still stop within `distance_m` (negative: must back off), smooth at zero: braking at
/// `acceleration_m_s2`, in proportion to the distance with 1/`time_s` close to the end.
double stopping_speed_m_s(double distance_m, double acceleration_m_s2, double time_s);

}  // namespace eciton::control
