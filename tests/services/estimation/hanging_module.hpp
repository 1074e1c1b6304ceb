// A module in hover that is not built as its model says: which thrusts its controller must ask for so that the true
// forces and moments balance, and what an observer of momentum reads meanwhile. Nothing here is linearised.
#pragma once

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "core/robot/model_errors.hpp"

namespace eciton::estimation {

struct TrueModel {
  std::array<double, robot::rotors_max> thrust_share{};  // by which the true thrust exceeds the model's
  double mass_share = 0;
  robot::Vector3 com_m = robot::Vector3::Zero();
  robot::Vector3 attitude_rad = robot::Vector3::Zero();  // measured = true Exp(attitude)

  static TrueModel of(const robot::ModelErrors& errors) {
    TrueModel out;
    for (std::size_t k = 0; k < robot::rotors_max; ++k) out.thrust_share[k] = errors[static_cast<int>(k)];
    const int after = static_cast<int>(robot::rotors_max);
    out.mass_share = errors[after];
    out.com_m = errors.segment<3>(after + 1);
    out.attitude_rad = errors.segment<3>(after + 4);
    return out;
  }
  /// As the simulated world draws them.
  static TrueModel drawn(std::mt19937& rng) {
    const auto within = [&rng](double bound) { return std::uniform_real_distribution<double>(-bound, bound)(rng); };
    TrueModel out;
    for (double& share : out.thrust_share) share = within(0.05);
    out.mass_share = within(0.03);
    out.com_m = {within(0.003), within(0.003), within(0.003)};
    out.attitude_rad = {within(0.006), within(0.006), within(0.006)};
    return out;
  }
};

struct Reading {
  robot::Wrench observed_M;
  robot::BiasJacobian jacobian_M;
};

class HangingModule {
 public:
  explicit HangingModule(const TrueModel& truth) : truth_(truth) {}

  /// At a measured attitude. The balance is one of the rotors' thrust vectors, of least squares.
  Reading read(const robot::Matrix3& measured_R_WM) const {
    const robot::Airframe airframe = robot::legion();
    const robot::Matrix3 R = measured_R_WM * robot::exp_so3(truth_.attitude_rad).transpose();
    const double mass_kg = (1 + truth_.mass_share) * airframe.mass_kg;
    const robot::Vector3 weight_M = R.transpose() * robot::Vector3(0, 0, -mass_kg * robot::gravity_m_s2);
    const auto count = static_cast<Eigen::Index>(airframe.rotors.size());
    Eigen::MatrixXd true_wrench(6, 3 * count), model_wrench(6, 3 * count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const robot::RotorGeometry& rotor = airframe.rotors[static_cast<std::size_t>(k)];
      const auto per_thrust = [&](const robot::Vector3& com) {
        Eigen::Matrix<double, 6, 3> out;
        out << robot::Matrix3::Identity(),
            robot::skew(rotor.p_BR_m - com) + rotor.drag_ratio_m * robot::Matrix3::Identity();
        return out;
      };
      true_wrench.middleCols<3>(3 * k) =
          (1 + truth_.thrust_share[static_cast<std::size_t>(k)]) * per_thrust(truth_.com_m);
      model_wrench.middleCols<3>(3 * k) = per_thrust(robot::Vector3::Zero());
    }
    robot::Vector6 lift;
    lift << -weight_M, robot::Vector3::Zero();
    const Eigen::VectorXd thrusts = true_wrench.completeOrthogonalDecomposition().solve(lift);
    const robot::Vector6 known = model_wrench * thrusts;

    std::vector<robot::RotorOutput> rotors;
    for (Eigen::Index k = 0; k < count; ++k) {
      rotors.push_back(robot::rotor_output(thrusts.segment<3>(3 * k), {}, 4));
    }
    // (7) at rest: the momentum stays, so the wrench not known is what the known one and the model's weight lack.
    const robot::Vector3 model_weight_M =
        measured_R_WM.transpose() * robot::Vector3(0, 0, -airframe.mass_kg * robot::gravity_m_s2);
    return {{-known.head<3>() - model_weight_M, -known.tail<3>()},
            robot::bias_jacobian(airframe, rotors, robot::Vector3::Zero(), measured_R_WM)};
  }

 private:
  TrueModel truth_;
};

}  // namespace eciton::estimation
