// The way of a whole chain: none of its bodies comes near another's, its far end never moves fast.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "services/docking/approach_path.hpp"

namespace eciton::docking {
namespace {

constexpr double dt_s = 0.01;
constexpr double standoff_m = 0.30;
constexpr double module_m = 0.8;

struct Walk {
  double seconds = 0;
  double clearance_m = 1e9;
  double speed_m_s_max = 0;  // of any body
  bool arrived = false;
};

/// Bodies of a straight chain of `members`, the docking one first, behind its port F.
std::vector<Vector3> bodies_F(PortKind target_port, std::size_t members) {
  std::vector<Vector3> bodies;
  for (std::size_t k = 0; k < members; ++k) {
    bodies.push_back((module_m / 2 + module_m * static_cast<double>(k)) * outward_T(target_port));
  }
  return bodies;
}

Walk walk(const Pose& X_TF, PortKind target_port, std::size_t members, const std::vector<Vector3>& others_T,
          const ApproachPathConfig& config = {}) {
  const std::vector<Vector3> follower_F = bodies_F(target_port, members);
  ApproachPath path(config);
  path.carry(target_port, std::span(follower_F).subspan(1));
  path.start(X_TF, target_port);
  std::vector<Vector3> all_T = others_T;
  all_T.push_back(-module_m / 2 * outward_T(target_port));
  Walk w;
  for (; w.seconds < 90 && !path.arrived(); w.seconds += dt_s) {
    const Pose before = path.X_TF();
    path.update(dt_s, standoff_m, others_T);
    for (const Vector3& body_F : follower_F) {
      const Vector3 body_T = path.X_TF() * body_F;
      w.speed_m_s_max = std::max(w.speed_m_s_max, (body_T - before * body_F).norm() / dt_s);
      for (const Vector3& other_T : all_T) w.clearance_m = std::min(w.clearance_m, (body_T - other_T).norm());
    }
  }
  w.arrived = path.arrived();
  return w;
}

TEST(ChainPathTest, GoesStraightInWhenAligned) {
  const Walk w = walk({Vector3(1.5, 0.4, 0.3), robot::Matrix3::Identity()}, PortKind::male, 2, {});
  EXPECT_TRUE(w.arrived);
  // By hand: 1.3 m at 0.55 m/s, with ramps of 1 m/s^2.
  EXPECT_NEAR(w.seconds, Vector3(1.2, 0.4, 0.3).norm() / 0.55 + 0.55, 0.1);
  EXPECT_GE(w.clearance_m, 1.0);
}

TEST(ChainPathTest, TurnsWhereThereIsRoomForAllOfIt) {
  std::mt19937_64 random(3);
  const auto uniform = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    const PortKind target_port = trial % 2 == 0 ? PortKind::male : PortKind::female;
    const Vector3 out = outward_T(target_port);
    const std::size_t members = 2 + static_cast<std::size_t>(trial % 3);
    const std::vector<Vector3> mates{-1.5 * module_m * out, -2.5 * module_m * out};
    // Anywhere, turned anyhow about the vertical, as long as it begins clear.
    const robot::Matrix3 R = robot::exp_so3(Vector3(0, 0, uniform(-3.1, 3.1)));
    const Pose X_TF{uniform(1.5, 6) * Vector3(uniform(-1, 1), uniform(-1, 1), uniform(-.3, .3)).normalized(), R};
    bool clear = true;
    for (const Vector3& body_F : bodies_F(target_port, members)) {
      for (const Vector3& other : {Vector3(-0.5 * module_m * out), mates[0], mates[1]}) {
        clear = clear && (X_TF * body_F - other).norm() > 1.1;
      }
    }
    if (!clear) continue;
    const Walk w = walk(X_TF, target_port, members, mates);
    EXPECT_TRUE(w.arrived);
    EXPECT_GE(w.clearance_m, 0.95);
    EXPECT_LE(w.speed_m_s_max, 0.55 + 0.3 + 1e-6);
  }
}

TEST(ChainPathTest, BacksOutToTurnRoundAndWouldSweepTheTargetElse) {
  // In front of the port the wrong way round: two of its three bodies are between the port and its own end.
  const Pose X_TF{Vector3(2.9, 0, 0), robot::exp_so3(Vector3(0, 0, 3.0))};
  const Walk w = walk(X_TF, PortKind::male, 3, {});
  EXPECT_TRUE(w.arrived);
  EXPECT_GE(w.clearance_m, 1.0);
  EXPECT_LT(walk(X_TF, PortKind::male, 3, {}, {.clearance_m = 0.0, .swing_free_rad = 4}).clearance_m, 1.0);
}

}  // namespace
}  // namespace eciton::docking
