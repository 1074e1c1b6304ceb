// Motions of least jerk: the quintic, for one coordinate and for many that start and arrive together.
// Joint goals, pose goals and the chain's feed-forward all evaluate the same ones.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/robot/airframe.hpp"

namespace eciton::robot {

struct ScalarMotion {
  double position = 0;
  double velocity = 0;
  double acceleration = 0;
};

/// Quintic from any state to rest at a goal: of all curves between them in that time, the one of least
/// jerk. Before the start it gives the start's position at rest, after the end the goal.
class Quintic {
 public:
  Quintic() = default;
  Quintic(const ScalarMotion& from, double goal, double duration_s);

  ScalarMotion at(double t_s) const;
  double duration_s() const { return duration_s_; }

 private:
  std::array<double, 6> c_{};  // in units of the duration
  double duration_s_ = 0;
};

/// Greatest speed and acceleration of the rest-to-rest quintic are these times distance / duration (^2).
inline constexpr double quintic_speed_factor = 1.875;
inline constexpr double quintic_acceleration_factor = 5.773502691896258;  // 10 / sqrt(3)

/// Least duration of a rest-to-rest quintic within a rate and an acceleration limit.
double quintic_duration_s(double distance, double rate_max, double acceleration_max);

inline constexpr std::size_t coordinates_max = members_max * joints_max;

/// Many coordinates moved together by quintics of one duration. Copyable; no allocation.
class JointMotion {
 public:
  JointMotion() = default;
  /// All at rest.
  explicit JointMotion(std::span<const double> positions);

  /// From any state to rest at `goal`: as fast as the rate and acceleration limits let the slowest
  /// coordinate be. Started in motion, one quintic may have to strain the limits (a few per cent).
  void go(std::span<const ScalarMotion> from, std::span<const double> goal, double start_s, double rate_max,
          double acceleration_max);
  /// From any state to rest, wherever that is, within the acceleration limit.
  void stop(std::span<const ScalarMotion> from, double start_s, double acceleration_max);

  ScalarMotion at(std::size_t coordinate, double t_s) const { return motions_[coordinate].at(t_s - start_s_); }
  void at(double t_s, std::span<ScalarMotion> out) const;
  std::size_t size() const { return size_; }
  double start_s() const { return start_s_; }
  double duration_s() const { return duration_s_; }
  bool finished(double t_s) const { return t_s >= start_s_ + duration_s_; }

 private:
  /// Greatest share of a limit that is used; over 1: exceeded.
  double strain(double rate_max, double acceleration_max) const;
  void plan(std::span<const ScalarMotion> from, std::span<const double> goal, double duration_s);

  std::array<Quintic, coordinates_max> motions_{};
  std::size_t size_ = 0;
  double start_s_ = 0;
  double duration_s_ = 0;
};

}  // namespace eciton::robot
