// The way of a follower to a place in front of the target's port, from anywhere: a reference of limited speed
// that keeps its distance from other bodies. It moves the follower's body and turns it on the way; what hangs
// on that body, the rest of a chain, swings with it and keeps its distance too.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "services/docking/port_relation.hpp"

namespace eciton::docking {

struct ApproachPathConfig {
  double speed_m_s = 0.6;
  double acceleration_m_s2 = 2.0;
  double turn_rad_s = 1.0;
  double turn_rad_s2 = 10.0;
  double clearance_m = 1.0;     // between centres of bodies
  double via_gap_m = 1.2;       // first to this gap, where the straight way is barred
  double port_to_body_m = 0.4;  // from the docking point to the centre of a body, both modules

  // Of a chain: it is heavier, softer, and its far end moves by the rate of turning times its length.
  double chain_speed_m_s = 0.55;
  double chain_acceleration_m_s2 = 1.0;
  double swing_m_s = 0.3;  // of the far end
  double swing_m_s2 = 0.4;
  double swing_free_rad = 0.15;  // to turn by more than this, a chain needs room for all of it
};

class ApproachPath {
 public:
  static constexpr std::size_t bodies_max = 32;
  static constexpr std::size_t carried_max = robot::members_max;

  explicit ApproachPath(const ApproachPathConfig& config) : config_(config) {}

  /// What else moves with the follower's body: centres of the rest of its chain, axes and origin of its port F.
  /// Holds until the next call.
  void carry(PortKind target_port, std::span<const Vector3> bodies_F);
  bool carries() const { return carried_count_ > 0; }
  /// From where the follower's port is, at rest.
  void start(const Pose& X_TF, PortKind target_port);

  /// Moves on towards `gap_m` in front of the port, aligned. `bodies_T`: centres to stay clear of besides the
  /// target's, m, axes and origin of T. Real-time safe.
  void update(double dt_s, double gap_m, std::span<const Vector3> bodies_T);

  const Pose& X_TF() const { return X_TF_; }
  /// Of the follower's port, axes of T.
  const Vector3& v_TF() const { return v_TF_; }
  const Vector3& w_TF() const { return w_TF_; }
  /// Standing at the end of the way.
  bool arrived() const { return arrived_; }

 private:
  Vector3 body_of(const Pose& X_TF) const { return X_TF * (config_.port_to_body_m * outward_); }
  void find_obstacles(std::span<const Vector3> bodies_T);
  void add_obstacle(const Vector3& body_T);
  std::span<const Vector3> carried_F() const { return std::span(carried_F_).first(carried_count_); }
  std::span<const Vector3> obstacles_T() const { return std::span(obstacles_T_).first(obstacle_count_); }
  bool has_room_to_turn(std::span<const Vector3> bodies_T) const;
  /// How near the way may come to an obstacle: less than the clearance only where the goal itself is nearer.
  double radius_about(const Vector3& obstacle_T) const;
  bool bars_the_way(const Vector3& obstacle_T) const;
  void turn_away_from(const Vector3& obstacle_T, double reach_m, Vector3& direction) const;
  Vector3 direction_of_motion(const Vector3& waypoint, double reach_m) const;
  void move(double dt_s, const Vector3& waypoint, double left_m);
  robot::Matrix3 turn(double dt_s, const Vector3& angles, bool may_turn);

  ApproachPathConfig config_;
  Vector3 outward_ = Vector3::UnitX();
  Pose X_TF_;
  Vector3 v_TF_ = Vector3::Zero();
  Vector3 w_TF_ = Vector3::Zero();
  Vector3 place_ = Vector3::Zero();  // of the follower's body, in T
  Vector3 goal_ = Vector3::Zero();
  double speed_m_s_ = 0;
  double rate_rad_s_ = 0;
  bool arrived_ = false;

  std::array<Vector3, carried_max> carried_F_;  // from the follower's body, axes of F
  std::size_t carried_count_ = 0;
  double reach_m_ = 0;  // of the farthest of them
  /// Where the follower's body would meet another, or one it carries would.
  std::array<Vector3, (bodies_max + 1) * (carried_max + 1)> obstacles_T_;
  std::size_t obstacle_count_ = 0;
};

}  // namespace eciton::docking
