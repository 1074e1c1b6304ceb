// Barrier certificates and the rule of the road.
#include "services/control/separation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eciton::control {

using robot::PoseReference;
using robot::Vector3;

namespace {

constexpr std::size_t neighbours_max = 16;
constexpr double barrier_time_s = 0.4;    // approach is proportional to the room left, closer than braking needs
constexpr double barrier_rate_1_s = 6.0;  // how fast a bound is taken up
constexpr double back_off_m_s = 0.4;      // from whoever is too near already
constexpr double chase_time_s = 0.6;      // catching up with the nominal reference, well damped with ...
constexpr double chase_rate_1_s = 6.0;    // ... this rate of the velocity
constexpr double sink_m_s = 0.3;          // no faster down than this, or than the nominal reference
constexpr double waiting_m = 0.3;         // from the nominal reference
constexpr double caught_up_m = 1e-3;
constexpr double caught_up_m_s = 5e-3;
constexpr double turn_rad_max = 2.0;

Vector3 shortened(const Vector3& v, double norm_max) {
  const double norm = v.norm();
  return norm > norm_max ? Vector3(v * (norm_max / norm)) : v;
}

Vector3 turned_right(const Vector3& v, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * v.x() + s * v.y(), c * v.y() - s * v.x(), v.z()};
}

}  // namespace

double stopping_speed_m_s(double distance_m, double acceleration_m_s2, double time_s) {
  if (distance_m <= 0) return distance_m / time_s;
  const double knee = acceleration_m_s2 * time_s;
  return std::sqrt(knee * knee + 2 * acceleration_m_s2 * distance_m) - knee;
}

/// What the acceleration must keep, and the nearest acceleration that does.
struct Separation::Bounds {
  std::array<Bound, neighbours_max + 6> all;
  std::size_t count = 0;

  void add(const Vector3& n_W, double least_m_s2) {
    if (count < all.size()) all[count++] = {n_W, least_m_s2};
  }
  bool kept_by(const Vector3& a_W) const {
    return std::all_of(all.begin(), all.begin() + count,
                       [&](const Bound& b) { return b.n_W.dot(a_W) >= b.least_m_s2 - 1e-9; });
  }
  /// Hildreth's method on the dual; bounds that contradict each other are each kept in part.
  Vector3 nearest(const Vector3& wanted_W) const {
    constexpr int sweeps = 60;
    constexpr double softness = 0.02;
    std::array<double, neighbours_max + 6> force{};
    Vector3 a = wanted_W;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      for (std::size_t k = 0; k < count; ++k) {
        const double missing = all[k].least_m_s2 - all[k].n_W.dot(a) - softness * force[k];
        const double next = std::max(0.0, force[k] + missing / (1 + softness));
        a += (next - force[k]) * all[k].n_W;
        force[k] = next;
      }
    }
    return a;
  }
};

bool Separation::sees(const Neighbour& neighbour, const Vector3& p_WM, Sight& sight) const {
  const double age_s = std::max(0.0, neighbour.age_s);
  const bool silent = age_s > config_.silent_s;
  sight.p_W = neighbour.p_WM + neighbour.v_WM * std::min(age_s, config_.extrapolate_s);
  sight.v_W = age_s < config_.extrapolate_s ? neighbour.v_WM : Vector3::Zero();
  sight.gives_way = neighbour.gives_way && !silent;
  sight.silent_m =
      silent ? std::min(config_.silence_margin_m_max, (age_s - config_.silent_s) * config_.silence_growth_m_s) : 0;
  // Of the tracking error only what brings this module nearer to the other than its reference is.
  const Vector3 away = p_W_ - sight.p_W;
  const double nearer_m = (p_W_ - p_WM).head<2>().dot(away.head<2>().normalized());
  sight.least_m = config_.distance_m - (sight.gives_way ? impatience() * config_.pressing_m : 0) +
                  std::clamp(nearer_m, 0.0, config_.tracking_error_m_max);
  const double level_m = away.head<2>().norm(), height_m = std::abs(away.z());
  if (!away.allFinite() || level_m > config_.range_m || height_m > config_.height_m + config_.range_m) return false;
  // Kept off in height where that is what is kept already.
  if (height_m - config_.height_m > std::max(-0.3, level_m - sight.least_m)) {
    sight.away_W = {0, 0, std::copysign(1.0, away.z())};
    sight.distance_m = height_m;
    sight.least_m = config_.height_m;
    return level_m < sight.least_m + 0.5;
  }
  sight.away_W = level_m > 1e-3 ? Vector3(away.x() / level_m, away.y() / level_m, 0) : Vector3(1, 0, 0);
  sight.distance_m = level_m;
  return true;
}

void Separation::bound(const Sight& sight, Bounds& bounds) const {
  // Kept: rate + stopping(room) >= 0, rate being that of the distance; its derivative shared by those who give way.
  const double brakes = config_.acceleration_m_s2 * (sight.gives_way ? 2 : 1);
  const Vector3 relative = v_W_ - sight.v_W;
  const double rate = sight.away_W.dot(relative);
  double room = sight.distance_m - sight.least_m - sight.silent_m;
  if (room < 0) room = std::min(0.0, sight.distance_m - sight.least_m);
  const double allowed = std::max(-back_off_m_s, stopping_speed_m_s(room, brakes, barrier_time_s));
  const double slope = room > 0 ? brakes / (allowed + brakes * barrier_time_s) : 1 / barrier_time_s;
  const double across = relative.squaredNorm() - rate * rate - relative.z() * relative.z() * (sight.away_W.z() == 0);
  const double swing = sight.away_W.z() == 0 ? std::max(0.0, across) / std::max(0.3, sight.distance_m) : 0;
  const double changes = allowed > -back_off_m_s ? slope * rate : 0;
  const double least = -barrier_rate_1_s * (rate + allowed) - changes - swing;
  bounds.add(sight.away_W, sight.gives_way ? least / 2 : least);
}

void Separation::bound(const Fence& fence, Bounds& bounds) const {
  for (int k = 0; k < 3; ++k) {
    for (const double side : {1.0, -1.0}) {
      const double room = side > 0 ? p_W_[k] - fence.low_W[k] : fence.high_W[k] - p_W_[k];
      if (room > 3) continue;
      const double rate = side * v_W_[k], brakes = config_.acceleration_m_s2;
      const double allowed = std::max(-back_off_m_s, stopping_speed_m_s(room, brakes, barrier_time_s));
      const double slope = room > 0 ? brakes / (allowed + brakes * barrier_time_s) : 1 / barrier_time_s;
      bounds.add(side * Vector3::Unit(k),
                 -barrier_rate_1_s * (rate + allowed) - (allowed > -back_off_m_s ? slope * rate : 0));
    }
  }
}

double Separation::impatience() const {
  constexpr double grows_s = 3;
  return std::clamp((waiting_s_ - config_.patience_s) / grows_s, 0.0, 1.0);
}

double Separation::turn_right(const Sight& sight, const Vector3& wanted_v_W) const {
  // Only who meets this way, nearer than both like, is turned for: as far as it takes to leave the other on the left.
  if (sight.away_W.z() != 0) return 0;
  const double pass_m = sight.least_m + sight.silent_m + config_.rule_margin_m;
  const Vector3 relative = wanted_v_W - sight.v_W;
  const Eigen::Vector2d offset = (p_W_ - sight.p_W).head<2>(), closing = relative.head<2>();
  const double speed2 = closing.squaredNorm();
  const double when_s = speed2 > 1e-6 ? std::clamp(-offset.dot(closing) / speed2, 0.0, config_.look_ahead_s) : 0.0;
  if (when_s <= 0) return 0;
  const double miss_m = (offset + closing * when_s).norm();
  const double weight = (1 - impatience()) * std::clamp((pass_m - miss_m) / config_.rule_margin_m, 0.0, 1.0);
  if (weight <= 0 || wanted_v_W.head<2>().norm() < 1e-3) return 0;
  // Bearing of the other from the way this one wants to go, to the left positive.
  const Vector3 to = -sight.away_W;
  const double bearing = std::atan2(wanted_v_W.x() * to.y() - wanted_v_W.y() * to.x(),
                                    wanted_v_W.x() * to.x() + wanted_v_W.y() * to.y());
  const double clear = std::asin(std::min(1.0, pass_m / std::max(sight.distance_m, 1e-3)));
  return weight * std::clamp(clear - bearing, 0.0, turn_rad_max);
}

Vector3 Separation::wanted_velocity(const PoseReference& nominal) const {
  const Vector3 behind = nominal.p_WM - p_W_;
  const double distance = behind.norm();
  const double speed_max = std::max(config_.speed_m_s, nominal.v_WM.norm());
  Vector3 wanted = nominal.v_WM;
  if (distance > 1e-9) {
    wanted += behind * (stopping_speed_m_s(distance, config_.acceleration_m_s2 / 2, chase_time_s) / distance);
  }
  wanted.z() = std::max(wanted.z(), std::min(-sink_m_s, nominal.v_WM.z()));
  return shortened(wanted, speed_max);
}

PoseReference Separation::update(const SeparationInput& in, double dt_s) {
  const PoseReference& nominal = in.nominal;
  if (!gives_way_) {
    p_W_ = nominal.p_WM;
    v_W_ = nominal.v_WM;
  }
  const Vector3 wanted_v =
      gives_way_ ? wanted_velocity(nominal) : Vector3((in.p_WM_ahead - p_W_) / config_.look_ahead_s);
  Bounds bounds;
  double turn_rad = 0;
  for (const Neighbour& neighbour : in.neighbours) {
    Sight sight;
    if (!sees(neighbour, in.p_WM, sight)) continue;
    bound(sight, bounds);
    turn_rad = std::max(turn_rad, turn_right(sight, wanted_v));
  }
  bound(in.fence, bounds);
  const bool nothing_in_the_way = turn_rad <= 0 && bounds.kept_by(nominal.a_WM);
  const bool caught_up = (p_W_ - nominal.p_WM).norm() < caught_up_m && (v_W_ - nominal.v_WM).norm() < caught_up_m_s;
  gives_way_ = !(nothing_in_the_way && caught_up);
  const bool away = gives_way_ && (p_W_ - nominal.p_WM).norm() > waiting_m;
  waiting_s_ = away && waiting_s_ < config_.patience_s + config_.impatient_s ? waiting_s_ + dt_s : 0;
  if (!gives_way_) return nominal;

  const Vector3 turned_v = turned_right(wanted_velocity(nominal), turn_rad);
  const Vector3 wanted_a =
      (turn_rad > 0 ? Vector3(Vector3::Zero()) : nominal.a_WM) + chase_rate_1_s * (turned_v - v_W_);
  PoseReference out = nominal;
  out.a_WM = shortened(bounds.nearest(shortened(wanted_a, config_.acceleration_m_s2)), config_.acceleration_m_s2);
  p_W_ += v_W_ * dt_s + 0.5 * out.a_WM * dt_s * dt_s;
  v_W_ += out.a_WM * dt_s;
  out.p_WM = p_W_;
  out.v_WM = v_W_;
  return out;
}

}  // namespace eciton::control
