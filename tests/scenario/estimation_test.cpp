// What the services estimate in the whole simulated system, under the mismatch preset, against the physics' truth.
#include <gtest/gtest.h>

#include <cmath>

#include "core/robot/arrays.hpp"
#include "tests/scenario/fleet.hpp"

namespace eciton::deploy {
namespace {

using robot::Vector3;

TEST(EstimationScenarioTest, TheFilterAssumesNoLessNoiseThanTheWorldMakes) {
  const hal::sim::WorldConfig world;
  const estimation::ErrorStateFilterConfig filter;
  for (const double rate_Hz : {world.imu.rate_Hz, 200.0}) {
    EXPECT_LE(world.imu.accelerometer_noise_m_s2 / std::sqrt(rate_Hz), filter.accelerometer_noise_m_s2_rtHz);
    EXPECT_LE(world.imu.gyroscope_noise_rad_s / std::sqrt(rate_Hz), filter.gyroscope_noise_rad_s_rtHz);
  }
  // An attitude bias of 10 mrad reads as an accelerometer bias beside the real one.
  EXPECT_LE(std::hypot(world.imu.accelerometer_bias_m_s2, 0.010 * robot::gravity_m_s2 / std::sqrt(2)),
            filter.accelerometer_bias_std_initial_m_s2);
  EXPECT_LE(world.imu.gyroscope_bias_rad_s, filter.gyroscope_bias_std_initial_rad_s);
}

struct Errors {
  double position_m_max = 0, attitude_rad_max = 0, position_m_square = 0;
  int samples = 0;
  double position_m_rms() const { return std::sqrt(position_m_square / samples); }
};

/// Hover, then to and fro at 0.8 m/s with turns; what the state was off by.
std::pair<Errors, Errors> hover_and_fly(const std::string& sensing, std::uint64_t seed) {
  SimulationConfig config = row_of(1, seed);
  config.world.sensing = sensing;
  Simulation simulation(config);
  Pilot pilot(simulation);
  auto states = simulation.listener(0).create_reader(topics::module_state);
  pilot.bring_to_hover({1.5});
  const auto watch = [&](Errors& errors) {
    const auto state = states.take_newest();
    if (!state || state->value.mode != msg::EstimatorMode::ready) return;
    // The state is of this tick, in which the world has moved on by one: as far as its velocity goes.
    const hal::sim::TruthPose truth = simulation.world().truth_pose(1);
    const double ahead_s = to_s(truth.stamp - from_ns(state->value.stamp_ns));
    const Vector3 p = truth.p_WM_m - ahead_s * truth.v_WM_m_s;
    const robot::Matrix3 R = truth.X_WB.R * robot::exp_so3(-ahead_s * truth.w_WM_M_rad_s);
    const double error_m = (robot::vector(state->value.p_WM_m) - p).norm();
    errors.position_m_max = std::max(errors.position_m_max, error_m);
    errors.position_m_square += error_m * error_m;
    errors.attitude_rad_max =
        std::max(errors.attitude_rad_max, robot::log_so3(robot::rotation(state->value.q_WM).transpose() * R).norm());
    ++errors.samples;
  };
  Errors hover, motion;
  pilot.wait_until([&] { return watch(hover), false; }, 5);
  for (const double x : {2.0, 0.0, 2.0}) {
    const std::uint64_t goal = pilot.op().go_to(1, {x, 0.5 * x, 1.5 + 0.2 * x}, 0.5 * x, 0.8);
    pilot.wait_until([&] { return watch(motion), is_over(pilot.op().report(goal)->progress); }, 15);
    EXPECT_EQ(pilot.op().report(goal)->progress, GoalProgress::succeeded);
  }
  EXPECT_GT(hover.samples, 200);
  EXPECT_GT(motion.samples, 300);
  return {hover, motion};
}

TEST(EstimationScenarioTest, MotionCaptureIsGoodToFiveMillimetresAndFifteenMilliradians) {
  for (const std::uint64_t seed : {3, 4, 5}) {
    const auto [hover, motion] = hover_and_fly("mocap", seed);
    for (const Errors& errors : {hover, motion}) {
      EXPECT_LT(errors.position_m_max, 0.005) << seed;
      EXPECT_LT(errors.attitude_rad_max, 0.015) << seed;
    }
  }
}

TEST(EstimationScenarioTest, LidarIsGoodToThirtyFiveMillimetres) {
  for (const std::uint64_t seed : {3, 4, 5}) {
    const auto [hover, motion] = hover_and_fly("lio", seed);
    for (const Errors& errors : {hover, motion}) {
      EXPECT_LT(errors.position_m_max, 0.035) << seed;
      EXPECT_LT(errors.attitude_rad_max, 0.02) << seed;
    }
  }
}

/// One module hovering; its external wrench as it is told to the others.
struct Hovering {
  explicit Hovering(std::uint64_t seed) : simulation(row_of(1, seed)), pilot(simulation) {
    pilot.bring_to_hover({1.5});
    pilot.wait(1);
  }
  /// Mean over a time.
  robot::Wrench mean(double duration_s) {
    robot::Wrench sum;
    int samples = 0;
    while (wrenches.take()) {
    }
    pilot.wait_until(
        [&] {
          while (const auto w = wrenches.take()) {
            sum += {robot::vector(w->value.force_W_N), robot::vector(w->value.moment_W_Nm)};
            quality_N = w->value.zero_quality_N;
            ++samples;
          }
          return false;
        },
        duration_s);
    EXPECT_GT(samples, 40 * duration_s);
    return sum * (1.0 / samples);
  }
  Simulation simulation;
  Pilot pilot;
  bus::Reader<msg::ExternalWrench> wrenches{simulation.listener(0).create_reader(topics::external_wrench)};
  double quality_N = 0;
};

TEST(WrenchScenarioTest, AForceOnAHoveringModuleIsFoundAsGoodAsTheZeroIs) {
  for (const std::uint64_t seed : {3, 4, 5}) {
    Hovering module(seed);
    const robot::Wrench before = module.mean(2);
    EXPECT_GT(module.quality_N, 0);
    EXPECT_LT(before.force.norm(), 4 * module.quality_N + 0.15) << "zeroed " << seed;
    const robot::Wrench push{{3, -2, 1}, {0.1, 0.2, -0.1}};
    module.simulation.world().set_external_wrench(1, push);
    module.pilot.wait(1);
    const robot::Wrench after = module.mean(3);
    // Beyond the zero's own spread: the thrust that now holds against the push is off by up to 5 %.
    const double bound_N = 4 * module.quality_N + 0.05 * push.force.norm() + 0.15;
    EXPECT_LT((after.force - push.force).norm(), bound_N) << seed;
    EXPECT_LT((after.moment - push.moment).norm(), 0.08) << seed;
    EXPECT_LT(bound_N, 1) << "else this says little";
  }
}

TEST(WrenchScenarioTest, AForceIsFoundWithinTheObserversTimeConstant) {
  Hovering module(3);
  const double before_N = module.mean(1).force.x();
  const double began_s = module.simulation.elapsed_s();
  module.simulation.world().set_external_wrench(1, {{5, 0, 0}, {0, 0, 0}});
  double found_s = 0;
  module.pilot.wait_until(
      [&] {
        while (const auto w = module.wrenches.take()) {
          if (found_s == 0 && w->value.force_W_N[0] - before_N > 5 * (1 - std::exp(-1.0))) {
            found_s = module.simulation.elapsed_s() - began_s;
          }
        }
        return found_s > 0;
      },
      2);
  // 1 / K is 0.1 s; the velocity that the observer sees comes a little later than it is.
  EXPECT_GT(found_s, 0.06);
  EXPECT_LT(found_s, 0.25);
}

TEST(WrenchScenarioTest, ZeroingIsAnsweredByWhoDoesItAndTruthfully) {
  Simulation simulation(row_of(1, 6));
  Pilot pilot(simulation);
  auto events = simulation.listener(0).create_reader(topics::event);
  std::vector<std::string> heard;
  const auto hear = [&] {
    while (const auto e = events.take()) {
      if (e->value.machine.view() == "zeroing")
        heard.emplace_back(std::string(e->value.to) + " " + e->value.detail.c_str());
    }
    return false;
  };
  pilot.wait(1);
  std::uint64_t goal = pilot.op().zero(1);
  EXPECT_EQ(pilot.follow(goal, 5), GoalProgress::refused);
  EXPECT_NE(pilot.op().report(goal)->reason.find("hover"), std::string::npos) << pilot.op().report(goal)->reason;
  pilot.bring_to_hover({1.2});
  hear();
  heard.clear();

  const double began_s = simulation.elapsed_s();
  goal = pilot.op().zero(1);
  pilot.wait_until([&] { return hear(), is_over(pilot.op().report(goal)->progress); }, 20);
  EXPECT_EQ(pilot.op().report(goal)->progress, GoalProgress::succeeded);
  EXPECT_GT(simulation.elapsed_s() - began_s, 5) << "it takes its time";
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_NE(heard[1].find("mN"), std::string::npos) << heard[1];

  // In a gale that swells, no bias can be told from the wind.
  goal = pilot.op().zero(1);
  int k = 0;
  pilot.wait_until(
      [&] {
        simulation.world().set_wind({9 * std::sin(0.016 * ++k), 0, 0});
        return hear(), is_over(pilot.op().report(goal)->progress);
      },
      45);
  EXPECT_EQ(pilot.op().report(goal)->progress, GoalProgress::aborted);
  const std::string reason = pilot.op().report(goal)->reason;
  EXPECT_TRUE(reason.find("unsteady") != std::string::npos || reason.find("moving") != std::string::npos) << reason;
}

/// A chain of two or three; estimates and truth of its first link, means over a time.
struct Chained {
  explicit Chained(std::uint32_t modules, std::uint64_t seed) : simulation(row_of(modules, seed)), pilot(simulation) {
    pilot.bring_to_hover(heights(modules));
    for (std::uint32_t id = 2; id <= modules; ++id) {
      EXPECT_EQ(pilot.dock(id, id - 1, 40).progress, GoalProgress::succeeded);
    }
    EXPECT_TRUE(pilot.wait_until([&] { return in_one_chain(pilot, modules); }, 5));
  }
  std::vector<std::pair<robot::Wrench, robot::Wrench>> means(double duration_s) {
    const auto links = static_cast<std::size_t>(simulation.size() - 1);
    std::vector<std::pair<robot::Wrench, robot::Wrench>> sums(links);
    int samples = 0;
    pilot.wait_until(
        [&] {
          const auto estimate = contacts.take_newest();
          if (!estimate || estimate->value.members.size() != simulation.size()) return false;
          for (std::size_t k = 0; k < links; ++k) {
            const auto& m = estimate->value.members[k];
            sums[k].first += {robot::vector(m.link_force_W_N), robot::vector(m.link_moment_W_Nm)};
            const auto truth = simulation.world().truth_contact(m.module_id, 0);
            if (truth) sums[k].second += truth->wrench_P_W;
          }
          ++samples;
          return false;
        },
        duration_s);
    for (auto& [estimate, truth] : sums) {
      estimate = estimate * (1.0 / samples);
      truth = truth * (1.0 / samples);
    }
    return sums;
  }
  Simulation simulation;
  Pilot pilot;
  bus::Reader<msg::ContactWrench> contacts{simulation.listener(0).create_reader(topics::contact_wrench)};
};

TEST(WrenchScenarioTest, ContactsOfAChainAreWhatThePhysicsSays) {
  for (const std::uint32_t modules : {2U, 3U}) {
    Chained chain(modules, 5);
    chain.pilot.wait(3);
    // A push on all alike is no contact, and is told apart from one.
    for (std::uint32_t id = 1; id <= modules; ++id) {
      chain.simulation.world().set_external_wrench(id, {{0, 4, 0}, {0, 0, 0}});
    }
    chain.pilot.wait(3);
    for (const auto& [estimate, truth] : chain.means(2)) {
      EXPECT_LT((estimate.force - truth.force).norm(), 0.7) << modules;
      EXPECT_LT((estimate.moment - truth.moment).norm(), 0.25) << modules;
    }
    // A wanted contact: pressed together with 4 N.
    std::vector<msg::DesiredContact> wanted(modules - 1);
    for (auto& link : wanted) link.force_M_N = {4, 0, 0};
    ASSERT_EQ(chain.pilot.follow(chain.pilot.op().contact(1, wanted), 5), GoalProgress::succeeded);
    chain.pilot.wait(4);
    for (const auto& [estimate, truth] : chain.means(2)) {
      EXPECT_GT(truth.force.norm(), 2.5) << "else nothing was measured";
      EXPECT_LT((estimate.force - truth.force).norm(), 0.7) << modules;
      EXPECT_LT((estimate.moment - truth.moment).norm(), 0.25) << modules;
    }
  }
}

}  // namespace
}  // namespace eciton::deploy
