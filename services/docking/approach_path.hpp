// The way of a follower to a place in front of the target's port, from anywhere: a reference of limited speed
// that keeps its distance from other bodies. It moves the follower's body and turns it on the way.
#pragma once

#include <span>

#include "services/docking/port_relation.hpp"

namespace eciton::docking {

struct ApproachPathConfig {
  double speed_m_s = 0.6;
  double acceleration_m_s2 = 2.0;
  double turn_rad_s = 1.0;
  double clearance_m = 1.0;     // between centres of bodies
  double via_gap_m = 1.2;       // first to this gap, where the straight way is barred
  double port_to_body_m = 0.4;  // from the docking point to the centre of a body, both modules
};

class ApproachPath {
 public:
  explicit ApproachPath(const ApproachPathConfig& config) : config_(config) {}

  /// From where the follower's port is, at rest.
  void start(const Pose& X_TF, PortKind target_port);

  /// Moves on towards `gap_m` in front of the port, aligned. `bodies_T`: centres to stay clear of besides the
  /// target's, m, axes and origin of T. Real-time safe.
  void update(double dt_s, double gap_m, std::span<const Vector3> bodies_T);

  const Pose& X_TF() const { return X_TF_; }
  /// Of the follower's port, axes of T.
  const Vector3& v_TF() const { return v_TF_; }
  /// Standing at the end of the way.
  bool arrived() const { return arrived_; }

 private:
  Vector3 body_of(const Pose& X_TF) const { return X_TF * (config_.port_to_body_m * outward_); }
  /// How near the way may come to a body: less than the clearance only where the goal itself is nearer.
  double radius_about(const Vector3& body_T) const;
  bool bars_the_way(const Vector3& body_T) const;
  void turn_away_from(const Vector3& body_T, double reach_m, Vector3& direction) const;
  Vector3 direction_of_motion(const Vector3& waypoint, double reach_m, std::span<const Vector3> bodies_T) const;

  ApproachPathConfig config_;
  Vector3 outward_ = Vector3::UnitX();
  Pose X_TF_;
  Vector3 v_TF_ = Vector3::Zero();
  Vector3 place_ = Vector3::Zero();  // of the follower's body, in T
  Vector3 goal_ = Vector3::Zero();
  double speed_m_s_ = 0;
  bool arrived_ = false;
};

}  // namespace eciton::docking
