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

RotorOutput Allocator::limited(std::size_t k, const Vector3& thrust_B_N, Allocation& out) const {
  const RotorGeometry& rotor = airframe_.rotors[k];
  RotorOutput o = rotor.gimbal_rad_max <= 0 ? RotorOutput{thrust_B_N.z(), {0, 0}}
                                            : rotor_output(thrust_B_N, gimbal_rad_[k], rotor.gimbal_rad_max);
  const double limited_N = std::clamp(o.thrust_N, rotor.thrust_N_min, rotor.thrust_N_max);
  out.thrust_limited = out.thrust_limited || std::abs(limited_N - o.thrust_N) > 1e-6;
  o.thrust_N = limited_N;
  for (double& angle : o.gimbal_rad) {
    const double limited_rad = std::clamp(angle, -rotor.gimbal_rad_max, rotor.gimbal_rad_max);
    out.gimbal_limited = out.gimbal_limited || limited_rad != angle;
    angle = limited_rad;
  }
  return o;
}

void Allocator::keep_moment(const Blocks& Q, const Vector3& moment_B, Allocation& out) const {
  // Projections by turns: on the thrusts that make the moment, and on those that the rotors can give.
  constexpr int turns = 12;
  constexpr double close_Nm = 1e-6;
  const std::size_t n = out.rotor_count;
  Matrix3 MMt = Matrix3::Zero();
  for (std::size_t k = 0; k < n; ++k) MMt.noalias() += Q[k].bottomRows<3>() * Q[k].bottomRows<3>().transpose();
  const Eigen::LDLT<Matrix3> factors(MMt);
  std::array<RotorOutput, rotors_max> rotors = out.rotors;
  double best_Nm = 1e9;
  for (int turn = 0; turn <= turns; ++turn) {
    Vector3 missing = moment_B;
    for (std::size_t k = 0; k < n; ++k) missing -= Q[k].bottomRows<3>() * thrust_vector_B(rotors[k]);
    if (missing.norm() < best_Nm) {
      best_Nm = missing.norm();
      out.rotors = rotors;
    }
    if (best_Nm < close_Nm || turn == turns) return;
    const Vector3 y = factors.solve(missing);
    for (std::size_t k = 0; k < n; ++k) {
      rotors[k] = limited(k, thrust_vector_B(rotors[k]) + Q[k].bottomRows<3>().transpose() * y, out);
    }
  }
}

Allocation Allocator::update(const Wrench& demanded_B, const Vector3& com_offset_B) {
  const std::size_t n = airframe_.rotors.size();
  Blocks Q;
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
  // What may be dropped of the force: of more than the weight, all that is more.
  const double weight_N = 1.1 * airframe_.mass_kg * gravity_m_s2, force_N = demanded_B.force.norm();
  const double force_scale_min = config_.force_scale_min * (force_N > weight_N ? weight_N / force_N : 1);
  choose_scales(airframe_, force_scale_min, for_force, for_moment, out);
  for (std::size_t k = 0; k < n; ++k) {
    out.rotors[k] = limited(k, out.force_scale * for_force[k] + out.moment_scale * for_moment[k], out);
  }
  if (out.thrust_limited || out.gimbal_limited) keep_moment(Q, out.moment_scale * demanded_B.moment, out);
  for (std::size_t k = 0; k < n; ++k) gimbal_rad_[k] = out.rotors[k].gimbal_rad;
  out.achieved_B = rotor_wrench_B(airframe_, out.outputs(), com_offset_B);
  return out;
}

void Allocator::set_gimbals(std::span<const RotorOutput> rotors) {
  for (std::size_t k = 0; k < std::min(rotors.size(), airframe_.rotors.size()); ++k) {
    gimbal_rad_[k] = rotors[k].gimbal_rad;
  }
}

}  // namespace eciton::robot
