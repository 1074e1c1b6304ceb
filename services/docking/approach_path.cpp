// Straight on where the way is free; around the bodies that bar it where not.
#include "services/docking/approach_path.hpp"

#include <algorithm>

namespace eciton::docking {
namespace {

constexpr double margin_m = 0.05;

double distance_to_segment(const Vector3& x, const Vector3& from, const Vector3& to) {
  const Vector3 along = to - from;
  const double length2 = along.squaredNorm();
  const double s = length2 > 0 ? std::clamp((x - from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (x - from - s * along).norm();
}

Vector3 sideways_from(const Vector3& n) {
  // T's z is about up: level rather than above or below, where the rotors' wakes are.
  const Vector3 level = Vector3::UnitZ().cross(n);
  return (level.norm() > 0.1 ? level : Vector3(Vector3::UnitX().cross(n))).normalized();
}

}  // namespace

void ApproachPath::start(const Pose& X_TF, PortKind target_port) {
  outward_ = outward_T(target_port);
  X_TF_ = X_TF;
  v_TF_.setZero();
  place_ = body_of(X_TF);
  speed_m_s_ = 0;
  arrived_ = false;
}

double ApproachPath::radius_about(const Vector3& body_T) const {
  return std::min(config_.clearance_m + margin_m, (goal_ - body_T).norm() - margin_m);
}

bool ApproachPath::bars_the_way(const Vector3& body_T) const {
  const double radius = radius_about(body_T);
  // Within the radius the straight way is good as long as it leads out, as from a docking that failed.
  if ((place_ - body_T).norm() < radius) return (goal_ - place_).dot(place_ - body_T) < 0;
  return distance_to_segment(body_T, place_, goal_) < radius - 1e-6;
}

void ApproachPath::turn_away_from(const Vector3& body_T, double reach_m, Vector3& direction) const {
  const Vector3 away = place_ - body_T;
  const double distance = away.norm();
  const double radius = radius_about(body_T);
  if (distance > radius + reach_m) return;
  const Vector3 n = distance > 1e-3 ? Vector3(away / distance) : outward_;
  const double inward = -direction.dot(n);
  if (inward <= 0) return;
  direction += inward * n;
  if (direction.norm() < 1e-3) direction = sideways_from(n);
  if (distance < radius) direction += n;  // too near already: out as well as around
  direction.normalize();
}

Vector3 ApproachPath::direction_of_motion(const Vector3& waypoint, double reach_m,
                                          std::span<const Vector3> bodies_T) const {
  Vector3 direction = (waypoint - place_).normalized();
  const Vector3 target_T = -config_.port_to_body_m * outward_;
  for (int round = 0; round < 3; ++round) {  // turning from one body may turn towards another
    turn_away_from(target_T, reach_m, direction);
    for (const Vector3& body_T : bodies_T) turn_away_from(body_T, reach_m, direction);
  }
  return direction;
}

void ApproachPath::update(double dt_s, double gap_m, std::span<const Vector3> bodies_T) {
  if (!(dt_s > 0)) return;
  goal_ = (gap_m + config_.port_to_body_m) * outward_;
  const bool barred =
      bars_the_way(-config_.port_to_body_m * outward_) ||
      std::any_of(bodies_T.begin(), bodies_T.end(), [&](const Vector3& b) { return bars_the_way(b); });
  const Vector3 waypoint = barred ? (config_.via_gap_m + config_.port_to_body_m) * outward_ : goal_;
  const double left_m = (goal_ - place_).norm();
  speed_m_s_ = std::min({config_.speed_m_s, speed_m_s_ + config_.acceleration_m_s2 * dt_s,
                         std::sqrt(2 * config_.acceleration_m_s2 * left_m)});
  const double step_m = std::min(speed_m_s_ * dt_s, left_m);
  if (left_m > 1e-4) {
    place_ += step_m * direction_of_motion(waypoint, step_m, bodies_T);
  } else {
    place_ = goal_;
    speed_m_s_ = 0;
  }

  const Vector3 turn = robot::log_so3(X_TF_.R);
  const double angle = turn.norm();
  const robot::Matrix3 R = angle > config_.turn_rad_s * dt_s
                               ? robot::exp_so3(turn * (1 - config_.turn_rad_s * dt_s / angle))
                               : robot::Matrix3(robot::Matrix3::Identity());
  const Pose next{place_ - R * (config_.port_to_body_m * outward_), R};
  v_TF_ = (next.p - X_TF_.p) / dt_s;
  X_TF_ = next;
  arrived_ = place_ == goal_ && angle <= config_.turn_rad_s * dt_s;
}

}  // namespace eciton::docking
