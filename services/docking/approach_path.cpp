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

void ApproachPath::carry(PortKind target_port, std::span<const Vector3> bodies_F) {
  carried_count_ = std::min(bodies_F.size(), carried_max);
  reach_m_ = 0;
  for (std::size_t k = 0; k < carried_count_; ++k) {
    carried_F_[k] = bodies_F[k] - config_.port_to_body_m * outward_T(target_port);
    reach_m_ = std::max(reach_m_, carried_F_[k].norm());
  }
}

void ApproachPath::start(const Pose& X_TF, PortKind target_port) {
  outward_ = outward_T(target_port);
  X_TF_ = X_TF;
  v_TF_.setZero();
  w_TF_.setZero();
  place_ = body_of(X_TF);
  speed_m_s_ = rate_rad_s_ = 0;
  arrived_ = false;
}

void ApproachPath::add_obstacle(const Vector3& body_T) {
  obstacles_T_[obstacle_count_++] = body_T;
  for (const Vector3& carried : carried_F()) obstacles_T_[obstacle_count_++] = body_T - X_TF_.R * carried;
}

void ApproachPath::find_obstacles(std::span<const Vector3> bodies_T) {
  obstacle_count_ = 0;
  add_obstacle(-config_.port_to_body_m * outward_);
  for (const Vector3& body_T : bodies_T.first(std::min(bodies_T.size(), bodies_max))) add_obstacle(body_T);
}

bool ApproachPath::has_room_to_turn(std::span<const Vector3> bodies_T) const {
  const double room_m = reach_m_ + config_.clearance_m;
  const auto leaves_room = [&](const Vector3& body_T) { return (body_T - place_).norm() > room_m; };
  return leaves_room(-config_.port_to_body_m * outward_) &&
         std::all_of(bodies_T.begin(), bodies_T.end(), leaves_room);
}

double ApproachPath::radius_about(const Vector3& obstacle_T) const {
  return std::min(config_.clearance_m + margin_m, (goal_ - obstacle_T).norm() - margin_m);
}

bool ApproachPath::bars_the_way(const Vector3& obstacle_T) const {
  const double radius = radius_about(obstacle_T);
  // Within the radius the straight way is good as long as it leads out, as from a docking that failed.
  if ((place_ - obstacle_T).norm() < radius) return (goal_ - place_).dot(place_ - obstacle_T) < 0;
  return distance_to_segment(obstacle_T, place_, goal_) < radius - 1e-6;
}

void ApproachPath::turn_away_from(const Vector3& obstacle_T, double reach_m, Vector3& direction) const {
  const Vector3 away = place_ - obstacle_T;
  const double distance = away.norm();
  const double radius = radius_about(obstacle_T);
  if (distance > radius + reach_m) return;
  const Vector3 n = distance > 1e-3 ? Vector3(away / distance) : outward_;
  const double inward = -direction.dot(n);
  if (inward <= 0) return;
  direction += inward * n;
  if (direction.norm() < 1e-3) direction = sideways_from(n);
  if (distance < radius) direction += n;  // too near already: out as well as around
  direction.normalize();
}

Vector3 ApproachPath::direction_of_motion(const Vector3& waypoint, double reach_m) const {
  Vector3 direction = (waypoint - place_).normalized();
  for (int round = 0; round < 3; ++round) {  // turning from one body may turn towards another
    for (const Vector3& obstacle_T : obstacles_T()) turn_away_from(obstacle_T, reach_m, direction);
  }
  return direction;
}

void ApproachPath::update(double dt_s, double gap_m, std::span<const Vector3> bodies_T) {
  if (!(dt_s > 0)) return;
  find_obstacles(bodies_T);
  goal_ = (gap_m + config_.port_to_body_m) * outward_;
  const Vector3 angles = robot::log_so3(X_TF_.R);
  const bool swings = carries() && angles.norm() > config_.swing_free_rad;
  const std::span<const Vector3> obstacles = obstacles_T();
  const bool barred = std::any_of(obstacles.begin(), obstacles.end(),
                                  [&](const Vector3& obstacle_T) { return bars_the_way(obstacle_T); });
  if (swings) {
    // A chain turns where there is room for all of it, and comes in aligned.
    goal_ = (reach_m_ + config_.clearance_m + 4 * margin_m) * outward_;
    move(dt_s, goal_, (goal_ - place_).norm());
  } else {
    const double via_m = std::max(config_.via_gap_m, gap_m);
    move(dt_s, barred ? Vector3((via_m + config_.port_to_body_m) * outward_) : goal_, (goal_ - place_).norm());
  }
  const robot::Matrix3 R = turn(dt_s, angles, !swings || has_room_to_turn(bodies_T));
  const Pose next{place_ - R * (config_.port_to_body_m * outward_), R};
  v_TF_ = (next.p - X_TF_.p) / dt_s;
  X_TF_ = next;
  arrived_ = !swings && place_ == goal_ && rate_rad_s_ == 0;
}

void ApproachPath::move(double dt_s, const Vector3& waypoint, double left_m) {
  const double speed_m_s_max = carries() ? config_.chain_speed_m_s : config_.speed_m_s;
  const double acceleration_m_s2 = carries() ? config_.chain_acceleration_m_s2 : config_.acceleration_m_s2;
  speed_m_s_ =
      std::min({speed_m_s_max, speed_m_s_ + acceleration_m_s2 * dt_s, std::sqrt(2 * acceleration_m_s2 * left_m)});
  const double step_m = std::min(speed_m_s_ * dt_s, left_m);
  if (left_m > 1e-4) {
    place_ += step_m * direction_of_motion(waypoint, step_m);
  } else {
    place_ = waypoint;
    speed_m_s_ = 0;
  }
}

robot::Matrix3 ApproachPath::turn(double dt_s, const Vector3& angles, bool may_turn) {
  const double angle_rad = angles.norm();
  double rate_rad_s_max = config_.turn_rad_s, acceleration_rad_s2 = config_.turn_rad_s2;
  if (carries()) {
    rate_rad_s_max = std::min(rate_rad_s_max, config_.swing_m_s / reach_m_);
    acceleration_rad_s2 = std::min(acceleration_rad_s2, config_.swing_m_s2 / reach_m_);
  }
  if (!may_turn) rate_rad_s_max = std::max(0.0, rate_rad_s_ - acceleration_rad_s2 * dt_s);
  rate_rad_s_ = std::min(
      {rate_rad_s_max, rate_rad_s_ + acceleration_rad_s2 * dt_s, std::sqrt(2 * acceleration_rad_s2 * angle_rad)});
  if (angle_rad < 1e-4 || angle_rad <= rate_rad_s_ * dt_s) {
    rate_rad_s_ = 0;
    w_TF_.setZero();
    return robot::Matrix3::Identity();
  }
  w_TF_ = -rate_rad_s_ / angle_rad * angles;  // about its own axis: the same in T and in F
  return robot::exp_so3(angles * (1 - rate_rad_s_ * dt_s / angle_rad));
}

}  // namespace eciton::docking
