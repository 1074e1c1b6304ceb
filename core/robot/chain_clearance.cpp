// Capsules against capsules, along a motion.
#include "core/robot/chain_clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/robot/minimum_jerk.hpp"

namespace eciton::robot {
namespace {

enum class Part { rotor, spine, link };

struct Capsule {
  Vector3 from, to;
  double radius;
  Part part;
};

constexpr std::size_t capsules_max = rotors_max + joints_max + 1;

struct Shape {
  std::array<Capsule, capsules_max> capsules;
  std::size_t count = 0;
  Vector3 centre;
  double reach = 0;  // all of it is within this of the centre

  void add(const Vector3& from, const Vector3& to, double radius, Part part) {
    if (count == capsules.size()) return;
    capsules[count++] = {from, to, radius, part};
    reach = std::max({reach, (from - centre).norm() + radius, (to - centre).norm() + radius});
  }
};

Shape shape_of(const Airframe& airframe, const Pose& X_WB, std::span<const double> joint_rad,
               const ChainClearanceConfig& config) {
  Shape shape;
  shape.centre = X_WB.p;
  for (const RotorGeometry& rotor : airframe.rotors) {
    shape.add(X_WB * rotor.p_BR_m, X_WB * rotor.p_BR_m, config.rotor_radius_m, Part::rotor);
  }
  if (airframe.joints.size() >= 2) {
    shape.add(X_WB * airframe.joints[0].p_BJ_m, X_WB * airframe.joints[1].p_BJ_m, config.spine_radius_m, Part::spine);
  }
  for (std::size_t port = 0; port < airframe.ports.size(); ++port) {
    const JointGeometry& joint = airframe.joints[static_cast<std::size_t>(airframe.ports[port].joint)];
    shape.add(X_WB * joint.p_BJ_m, X_WB * port_pose_B(airframe, static_cast<int>(port), joint_rad).p,
              config.link_radius_m, Part::link);
  }
  return shape;
}

double gap(const Shape& a, const Shape& b, bool linked) {
  double least = 1e9;
  for (std::size_t i = 0; i < a.count; ++i) {
    for (std::size_t k = 0; k < b.count; ++k) {
      const Capsule &p = a.capsules[i], &q = b.capsules[k];
      if (linked && (p.part != Part::rotor || q.part != Part::rotor)) continue;
      least = std::min(least, segment_distance_m(p.from, p.to, q.from, q.to) - p.radius - q.radius);
    }
  }
  return least;
}

using Shapes = std::array<Shape, members_max>;

std::size_t shapes_of(const Airframe& airframe, std::span<const double> joint_rad, const ChainClearanceConfig& config,
                      Shapes& shapes) {
  const std::size_t n = airframe.joints.size();
  const std::size_t members = n > 0 ? std::min(joint_rad.size() / n, members_max) : 0;
  if (members == 0 || airframe.ports.size() < 2) return 0;
  std::array<Pose, members_max> X_WB;
  chain_poses(airframe, 0, {}, joint_rad, std::span(X_WB).first(members));
  for (std::size_t i = 0; i < members; ++i) {
    shapes[i] = shape_of(airframe, X_WB[i], joint_rad.subspan(i * n, n), config);
  }
  return members;
}

/// Fastest that a point of member `second` moves as seen from `first`, per unit of the way: no joint between them
/// moves it faster than the whole chain from there on is long.
double speed_bound(const Airframe& airframe, std::size_t first, std::size_t second, std::span<const double> by_rad,
                   double reach_m) {
  const std::size_t n = airframe.joints.size();
  double sum = 0;
  for (std::size_t i = first; i <= second; ++i) {
    const double lever_m = 2 * reach_m * static_cast<double>(second - i + 1);
    for (std::size_t k = 0; k < n; ++k) sum += std::abs(by_rad[i * n + k]) * lever_m;
  }
  return sum;
}

}  // namespace

double segment_distance_m(const Vector3& a0, const Vector3& a1, const Vector3& b0, const Vector3& b1) {
  // Ericson, "Real-Time Collision Detection", 5.1.9.
  const Vector3 a = a1 - a0, b = b1 - b0, r = a0 - b0;
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), f = b.dot(r);
  constexpr double tiny = 1e-12;
  double s = 0, t = 0;
  if (aa <= tiny && bb <= tiny) return r.norm();
  if (aa <= tiny) {
    t = std::clamp(f / bb, 0.0, 1.0);
  } else {
    const double c = a.dot(r);
    if (bb <= tiny) {
      s = std::clamp(-c / aa, 0.0, 1.0);
    } else {
      const double ab = a.dot(b), across = aa * bb - ab * ab;
      s = across > tiny ? std::clamp((ab * f - c * bb) / across, 0.0, 1.0) : 0;
      t = (ab * s + f) / bb;
      if (t < 0) {
        t = 0;
        s = std::clamp(-c / aa, 0.0, 1.0);
      } else if (t > 1) {
        t = 1;
        s = std::clamp((ab - c) / aa, 0.0, 1.0);
      }
    }
  }
  return (a0 + s * a - b0 - t * b).norm();
}

Nearness chain_clearance(const Airframe& airframe, std::span<const double> joint_rad,
                         const ChainClearanceConfig& config) {
  Shapes shapes;
  const std::size_t members = shapes_of(airframe, joint_rad, config, shapes);
  Nearness nearest;
  for (std::size_t i = 0; i < members; ++i) {
    for (std::size_t k = i + 1; k < members; ++k) {
      const double apart = (shapes[i].centre - shapes[k].centre).norm() - shapes[i].reach - shapes[k].reach;
      if (apart > nearest.clearance_m) continue;
      const double clearance = gap(shapes[i], shapes[k], k == i + 1);
      if (clearance < nearest.clearance_m) nearest = {i, k, clearance};
    }
  }
  return nearest;
}

std::optional<Nearness> check_chain_clearance(const Airframe& airframe, std::span<const double> from_rad,
                                              std::span<const double> to_rad, const ChainClearanceConfig& config) {
  const std::size_t size = std::min({from_rad.size(), to_rad.size(), coordinates_max});
  std::array<double, coordinates_max> by_rad{}, at_rad{};
  for (std::size_t k = 0; k < size; ++k) by_rad[k] = to_rad[k] - from_rad[k];
  const double limit =
      std::min(config.clearance_m, chain_clearance(airframe, from_rad.first(size), config).clearance_m);
  Shapes shapes;
  double way = 0;
  for (int step = 0; step < config.steps_max; ++step) {
    for (std::size_t k = 0; k < size; ++k) at_rad[k] = from_rad[k] + way * by_rad[k];
    const std::size_t members = shapes_of(airframe, std::span(at_rad).first(size), config, shapes);
    double stride = 1;
    for (std::size_t i = 0; i < members; ++i) {
      for (std::size_t k = i + 1; k < members; ++k) {
        const double speed = speed_bound(airframe, i, k, by_rad, shapes[i].reach);
        double room = (shapes[i].centre - shapes[k].centre).norm() - shapes[i].reach - shapes[k].reach - limit;
        if (room < speed * 0.05) room = gap(shapes[i], shapes[k], k == i + 1) - limit;
        if (room < -1e-9) return Nearness{i, k, room + limit};
        // Never shorter than a hundredth of the limit takes: what is missed so is less than that.
        if (speed > 0) stride = std::min(stride, std::max(room, 0.002) / speed);
      }
    }
    if (way >= 1) return std::nullopt;
    way = std::min(1.0, way + stride);
  }
  return chain_clearance(airframe, std::span(at_rad).first(size), config);
}

}  // namespace eciton::robot
