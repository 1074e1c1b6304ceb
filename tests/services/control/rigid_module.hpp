// One LEGION module as a rigid body behind its actuators' lags, integrated by Runge and Kutta's fourth
// order: a plant of the tests' own, sharing nothing with the controllers but the airframe's numbers.
#pragma once

#include "core/robot/actuator_lag.hpp"
#include "services/control/pose_control.hpp"

namespace eciton::control {

class RigidModule {
 public:
  explicit RigidModule(const robot::ActuatorLagConfig& lag = {}) : actuators(airframe, lag) {}

  /// 1 ms under rotor commands and an external wrench about the mass centre, world axes.
  void step(std::span<const robot::RotorOutput> commands, const Wrench& external_W) {
    constexpr double dt = 1e-3;
    actuators.update(commands, dt);
    const Wrench made_B = actuators.wrench_B(Vector3::Zero());
    const State k1 = rates(x_, made_B, external_W), k2 = rates(x_ + k1 * (dt / 2), made_B, external_W);
    const State k3 = rates(x_ + k2 * (dt / 2), made_B, external_W), k4 = rates(x_ + k3 * dt, made_B, external_W);
    x_ = x_ + (k1 + k2 * 2 + k3 * 2 + k4) * (dt / 6);
    x_.q.normalize();
  }

  ModuleMotion motion() const { return {x_.p, x_.v, robot::Quaternion(x_.q).toRotationMatrix(), x_.w}; }
  void set(const Vector3& p, const Matrix3& R) {
    x_.p = p;
    x_.q = robot::Quaternion(R).coeffs();
  }

  robot::Airframe airframe = robot::legion();
  robot::ActuatorLag actuators;

 private:
  struct State {
    Vector3 p = Vector3::Zero(), v = Vector3::Zero(), w = Vector3::Zero();
    Eigen::Vector4d q{0, 0, 0, 1};  // x, y, z, w
    State operator+(const State& o) const { return {p + o.p, v + o.v, w + o.w, q + o.q}; }
    State operator*(double s) const { return {p * s, v * s, w * s, q * s}; }
  };
  State rates(const State& x, const Wrench& made_B, const Wrench& external_W) const {
    const robot::Quaternion q(x.q);
    const Matrix3 R = q.normalized().toRotationMatrix();
    const Matrix3& I = airframe.I_B_kg_m2;
    State out;
    out.p = x.v;
    out.v = (R * made_B.force + external_W.force) / airframe.mass_kg - Vector3(0, 0, robot::gravity_m_s2);
    out.w = I.inverse() * (made_B.moment + R.transpose() * external_W.moment - x.w.cross(I * x.w));
    out.q = 0.5 * (q * robot::Quaternion(0, x.w.x(), x.w.y(), x.w.z())).coeffs();
    return out;
  }

  State x_;
};

}  // namespace eciton::control
