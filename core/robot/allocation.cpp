// Allocation of a wrench to rotors on gimbals, and back.
#include "core/robot/allocation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eciton::robot {
namespace {

using std::numbers::pi;

double angle_cost(double phi, double theta, const std::array<double, 2>& present_rad, double limit_rad) {
  const double outside = std::max(0.0, std::abs(phi) - limit_rad) + std::max(0.0, std::abs(theta) - limit_rad);
  return std::hypot(phi - present_rad[0], theta - present_rad[1]) + 10 * outside;
}

/// The s for which |a + s b| <= limit, as an interval; empty (1, 0) when there is none.
struct Interval {
  double from;
  double to;
};
Interval within(const Vector3& a, const Vector3& b, double limit) {
  const double bb = b.squaredNorm(), ab = a.dot(b), rest = a.squaredNorm() - limit * limit;
  if (bb < 1e-12) return rest <= 0 ? Interval{-1e9, 1e9} : Interval{1, 0};
  const double root = ab * ab - bb * rest;
  if (root < 0) return {1, 0};
  return {(-ab - std::sqrt(root)) / bb, (-ab + std::sqrt(root)) / bb};
}

using Thrusts = std::array<Vector3, rotors_max>;

/// Greatest s in [least, 1] for which |a_k + s b_k| stays within every rotor's limit; less than `least`
/// when there is none.
double greatest_scale(const Airframe& airframe, const Thrusts& a, double a_scale, const Thrusts& b, double least) {
  Interval all{least, 1};
  for (std::size_t k = 0; k < airframe.rotors.size(); ++k) {
    const Interval one = within(a_scale * a[k], b[k], airframe.rotors[k].thrust_N_max);
    all = {std::max(all.from, one.from), std::min(all.to, one.to)};
    if (one.from > one.to) return least - 1;
  }
  return all.from <= all.to ? all.to : least - 1;
}

void choose_scales(const Airframe& airframe, double force_scale_min, const Thrusts& force, const Thrusts& moment,
                   Allocation& out) {
  const double s = greatest_scale(airframe, moment, 1, force, force_scale_min);
  if (s >= force_scale_min) {
    out.force_scale = s;
    return;
  }
  out.force_scale = force_scale_min;
  const double t = greatest_scale(airframe, force, force_scale_min, moment, 0);
  if (t >= 0) {
    out.moment_scale = t;
    return;
  }
  out.moment_scale = 0;
  out.force_scale = std::max(0.0, greatest_scale(airframe, moment, 0, force, 0));
}

}  // namespace

Vector3 thrust_vector_B(const RotorOutput& rotor) {
  const double phi = rotor.gimbal_rad[0], theta = rotor.gimbal_rad[1];
  return rotor.thrust_N * Vector3(std::sin(theta), -std::sin(phi) * std::cos(theta), std::cos(phi) * std::cos(theta));
}

RotorOutput rotor_output(const Vector3& thrust_B_N, const std::array<double, 2>& present_rad, double gimbal_rad_max) {
  const double thrust = thrust_B_N.norm();
  if (thrust < 1e-9) return {0, present_rad};
  const double across = std::hypot(thrust_B_N.y(), thrust_B_N.z());
  if (across < 1e-9 * thrust) return {thrust, {present_rad[0], std::copysign(pi / 2, thrust_B_N.x())}};

  const double phi = std::atan2(-thrust_B_N.y(), thrust_B_N.z());
  const double theta = std::atan2(thrust_B_N.x(), across);
  const double other_phi = phi + (phi > 0 ? -pi : pi), other_theta = (theta > 0 ? pi : -pi) - theta;
  const bool other = angle_cost(other_phi, other_theta, present_rad, gimbal_rad_max) <
                     angle_cost(phi, theta, present_rad, gimbal_rad_max);
  if (other) return {thrust, {other_phi, other_theta}};
  return {thrust, {phi, theta}};
}

Wrench rotor_wrench_B(const Airframe& airframe, std::span<const RotorOutput> rotors, const Vector3& com_offset_B) {
  Wrench sum;
  for (std::size_t k = 0; k < std::min(rotors.size(), airframe.rotors.size()); ++k) {
    const Vector3 thrust = thrust_vector_B(rotors[k]);
    const RotorGeometry& rotor = airframe.rotors[k];
    sum += {thrust, (rotor.p_BR_m - com_offset_B).cross(thrust) + rotor.drag_ratio_m * thrust};
  }
  return sum;
}

Allocator::Allocator(const Airframe& airframe, const AllocationConfig& config)
    : config_(config), airframe_(airframe), full_rank_(true) {
  if (airframe_.rotors.size() > rotors_max) airframe_.rotors.resize(rotors_max);
  for (const RotorGeometry& rotor : airframe_.rotors) full_rank_ = full_rank_ && rotor.gimbal_rad_max > 0;
  full_rank_ = full_rank_ && airframe_.rotors.size() >= 3;
}

Vector6 Allocator::solve(const Matrix6& QQt, const Vector6& wrench) const {
  if (full_rank_) return QQt.ldlt().solve(wrench);
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(QQt);
  const double smallest = 1e-9 * eigen.eigenvalues().maxCoeff();
  Vector6 in_axes = eigen.eigenvectors().transpose() * wrench;
  for (int k = 0; k < 6; ++k)
    in_axes[k] = eigen.eigenvalues()[k] > smallest ? in_axes[k] / eigen.eigenvalues()[k] : 0;
  return eigen.eigenvectors() * in_axes;
}

Allocation Allocator::update(const Wrench& demanded_B, const Vector3& com_offset_B) {
  const std::size_t n = airframe_.rotors.size();
  std::array<Block, rotors_max> Q;
  Matrix6 QQt = Matrix6::Zero();
  for (std::size_t k = 0; k < n; ++k) {
    const RotorGeometry& rotor = airframe_.rotors[k];
    Q[k].topRows<3>().setIdentity();
    Q[k].bottomRows<3>() = skew(rotor.p_BR_m - com_offset_B) + rotor.drag_ratio_m * Matrix3::Identity();
    if (rotor.gimbal_rad_max <= 0) Q[k].leftCols<2>().setZero();  // fixed: thrust along z alone
    QQt.noalias() += Q[k] * Q[k].transpose();
  }
  Vector6 force = Vector6::Zero(), moment = Vector6::Zero();
  force.head<3>() = demanded_B.force;
  moment.tail<3>() = demanded_B.moment;
  const Vector6 y_force = solve(QQt, force), y_moment = solve(QQt, moment);
  Thrusts for_force, for_moment;
  for (std::size_t k = 0; k < n; ++k) {
    for_force[k] = Q[k].transpose() * y_force;
    for_moment[k] = Q[k].transpose() * y_moment;
  }

  Allocation out;
  out.rotor_count = n;
  choose_scales(airframe_, config_.force_scale_min, for_force, for_moment, out);
  for (std::size_t k = 0; k < n; ++k) {
    const RotorGeometry& rotor = airframe_.rotors[k];
    const Vector3 thrust = out.force_scale * for_force[k] + out.moment_scale * for_moment[k];
    RotorOutput& o = out.rotors[k];
    const bool fixed = rotor.gimbal_rad_max <= 0;
    o = fixed ? RotorOutput{thrust.z(), {0, 0}} : rotor_output(thrust, gimbal_rad_[k], rotor.gimbal_rad_max);
    const double limited_N = std::clamp(o.thrust_N, rotor.thrust_N_min, rotor.thrust_N_max);
    out.thrust_limited = out.thrust_limited || std::abs(limited_N - o.thrust_N) > 1e-6;
    o.thrust_N = limited_N;
    for (double& angle : o.gimbal_rad) {
      const double limited_rad = std::clamp(angle, -rotor.gimbal_rad_max, rotor.gimbal_rad_max);
      out.gimbal_limited = out.gimbal_limited || limited_rad != angle;
      angle = limited_rad;
    }
    gimbal_rad_[k] = o.gimbal_rad;
  }
  out.achieved_B = rotor_wrench_B(airframe_, out.outputs(), com_offset_B);
  return out;
}

void Allocator::set_gimbals(std::span<const RotorOutput> rotors) {
  for (std::size_t k = 0; k < std::min(rotors.size(), airframe_.rotors.size()); ++k) {
    gimbal_rad_[k] = rotors[k].gimbal_rad;
  }
}

}  // namespace eciton::robot
