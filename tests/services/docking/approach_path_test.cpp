// The way in front of the port: straight where it is free, around the target where it is not, never fast.
#include "services/docking/approach_path.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace eciton::docking {
namespace {

constexpr double dt_s = 0.01;
constexpr double standoff_m = 0.30;

struct Walk {
  double seconds = 0;
  double clearance_m = 1e9;  // from the target's body and others, while not within it from the start
  double speed_m_s_max = 0;
  double length_m = 0;
  bool arrived = false;
};

Walk walk(const Pose& X_TF, PortKind target_port, const std::vector<Vector3>& bodies_T = {}) {
  const ApproachPathConfig config;
  ApproachPath path(config);
  path.start(X_TF, target_port);
  const Vector3 out = outward_T(target_port);
  Walk w;
  Vector3 before = X_TF * (config.port_to_body_m * out);
  for (; w.seconds < 60 && !path.arrived(); w.seconds += dt_s) {
    path.update(dt_s, standoff_m, bodies_T);
    const Vector3 body = path.X_TF() * (config.port_to_body_m * out);
    w.speed_m_s_max = std::max(w.speed_m_s_max, (body - before).norm() / dt_s);
    w.length_m += (body - before).norm();
    before = body;
    w.clearance_m = std::min(w.clearance_m, (body + config.port_to_body_m * out).norm());
    for (const Vector3& other : bodies_T) w.clearance_m = std::min(w.clearance_m, (body - other).norm());
  }
  w.arrived = path.arrived();
  EXPECT_LT((path.X_TF().p - standoff_m * out).norm(), 1e-9);
  EXPECT_LT(robot::log_so3(path.X_TF().R).norm(), 1e-9);
  return w;
}

TEST(ApproachPathTest, GoesStraightFromInFront) {
  const Walk w = walk({Vector3(1.5, 0.4, 0.3), robot::Matrix3::Identity()}, PortKind::male);
  EXPECT_TRUE(w.arrived);
  const double straight_m = Vector3(1.2, 0.4, 0.3).norm();
  EXPECT_NEAR(w.length_m, straight_m, 1e-3);
  // By hand: ramps of 0.6/2 s at either end, and the rest at 0.6 m/s.
  EXPECT_NEAR(w.seconds, straight_m / 0.6 + 0.3, 0.05);
  EXPECT_LE(w.speed_m_s_max, 0.6 + 1e-9);
}

TEST(ApproachPathTest, GoesAroundTheTargetFromBehindIt) {
  for (const PortKind target_port : {PortKind::male, PortKind::female}) {
    const Vector3 behind = -3.0 * outward_T(target_port);
    const Walk w = walk({behind, robot::Matrix3::Identity()}, target_port);
    EXPECT_TRUE(w.arrived);
    EXPECT_GE(w.clearance_m, 1.0);
    EXPECT_LT(w.length_m, 3.3 + 2.5);
  }
}

TEST(ApproachPathTest, LeavesStraightWhenTooNearInTheCorridor) {
  const Walk w = walk({Vector3(0.02, 0.03, 0), robot::Matrix3::Identity()}, PortKind::male);
  EXPECT_TRUE(w.arrived);
  EXPECT_LT(w.length_m, 0.35);
}

TEST(ApproachPathTest, KeepsItsDistanceFromAnywhere) {
  std::mt19937_64 random(7);
  const auto uniform = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (int trial = 0; trial < 500; ++trial) {
    SCOPED_TRACE(trial);
    const PortKind target_port = trial % 2 == 0 ? PortKind::male : PortKind::female;
    const Vector3 out = outward_T(target_port);
    // A body 1.1 to 5 m from the target's, turned anyhow about the vertical.
    const Vector3 away = Vector3(uniform(-1, 1), uniform(-1, 1), uniform(-0.7, 0.7)).normalized();
    const Vector3 body = -0.4 * out + uniform(1.1, 5) * away;
    const robot::Matrix3 R = robot::exp_so3(Vector3(0, 0, uniform(-3.1, 3.1)));
    const Walk w = walk({body - R * (0.4 * out), R}, target_port);
    EXPECT_TRUE(w.arrived);
    EXPECT_GE(w.clearance_m, 1.0);
    EXPECT_LE(w.speed_m_s_max, 0.6 + 1e-9);
    EXPECT_LT(w.seconds, 20);
  }
}

TEST(ApproachPathTest, GoesAroundAWholeChain) {
  // Three more modules in line behind the target; the follower behind them all, and beside them.
  for (const double side_m : {0.0, 0.3, -1.2}) {
    SCOPED_TRACE(side_m);
    const std::vector<Vector3> chain{{-1.2, 0, 0}, {-2.0, 0, 0}, {-2.8, 0, 0}};
    const Walk w = walk({Vector3(-4.6, side_m, 0.1), robot::Matrix3::Identity()}, PortKind::male, chain);
    EXPECT_TRUE(w.arrived);
    EXPECT_GE(w.clearance_m, 1.0);
    EXPECT_LT(w.seconds, 20);
  }
}

TEST(ApproachPathTest, WouldGoThroughTheTargetIfItKeptNoDistance) {
  ApproachPath path({.clearance_m = 0.0});
  path.start({Vector3(-3, 0, 0), robot::Matrix3::Identity()}, PortKind::male);
  double clearance_m = 1e9;
  for (int k = 0; k < 2000; ++k) {
    path.update(dt_s, standoff_m, {});
    clearance_m = std::min(clearance_m, (path.X_TF() * Vector3(.4, 0, 0) + Vector3(.4, 0, 0)).norm());
  }
  EXPECT_LT(clearance_m, 0.1);
}

}  // namespace
}  // namespace eciton::docking
