// Separated flight through the whole system: distances by the physics, whatever the seed, the starts and the goals.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "deploy/experiments/crossing.hpp"

namespace eciton::deploy {
namespace {

using robot::Vector3;

Figures run(std::uint64_t seed, const std::string& broken = "", double gust_N = 0) {
  ExperimentConfig config;
  config.seed = seed;
  config.break_what = broken;
  config.simulation.world.gust_N = gust_N;
  return run_experiment(crossing_experiment, config, 1, [](std::uint32_t) {});
}

TEST(CrossingTest, FourExchangePlacesAtADistance) {
  for (const auto& [seed, gust_N] : {std::pair{11u, 0.0}, {12u, 1.0}}) {
    const Figures figures = run(seed, "", gust_N);
    EXPECT_GE(figures.metrics.at("distance_m_min"), 1.0) << "seed " << seed;
    EXPECT_EQ(figures.metrics.at("arrived"), 4) << "seed " << seed;
    EXPECT_LT(figures.metrics.at("time_s"), 40) << "seed " << seed;
  }
}

TEST(CrossingTest, WithoutSeparationTheyMeet) {
  EXPECT_LT(run(11, "no-separation").metrics.at("distance_m_min"), 0.6);
}

std::vector<Vector3> places(std::size_t n, std::mt19937_64& random) {
  const auto uniform = [&](double half) {
    return half * (2 * (static_cast<double>(random() >> 11) * 0x1.0p-53) - 1);
  };
  std::vector<Vector3> out;
  while (out.size() < n) {
    const double x = uniform(2.7), y = uniform(2.7), z = 1.5 + uniform(0.2);
    const Vector3 p(x, y, z);
    if (std::all_of(out.begin(), out.end(), [&](const Vector3& q) { return (p - q).head<2>().norm() > 1.5; })) {
      out.push_back(p);
    }
  }
  return out;
}

TEST(CrossingTest, AnyStartsAndGoalsAreFlownApart) {
  // Three here; services_control_test flies sixty with points for modules.
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    std::mt19937_64 random(seed);
    Crossing crossing;
    crossing.starts_W = places(4 + seed % 3, random);
    crossing.goals_W = places(crossing.starts_W.size(), random);
    crossing.speed_m_s.assign(crossing.starts_W.size(), 0.5 + 0.1 * static_cast<double>(seed));
    const Figures figures = fly_crossing({}, seed, crossing);
    EXPECT_GE(figures.metrics.at("distance_m_min"), 1.0) << "seed " << seed;
    EXPECT_EQ(figures.metrics.at("arrived"), static_cast<double>(crossing.starts_W.size())) << "seed " << seed;
  }
}

}  // namespace
}  // namespace eciton::deploy
