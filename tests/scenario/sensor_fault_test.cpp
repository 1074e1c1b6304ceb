// Sensors that break in flight: what they say is refused, counted and told of once, the module falls to the mode
// that the failure table names, and flies on when they are mended.
#include <gtest/gtest.h>

#include "tests/scenario/fleet.hpp"

namespace eciton::deploy {
namespace {

using hal::sim::SensorFaultKind;
using hal::sim::SimSensor;

/// One module hovering, and an ear on its ring.
class SensorFaultTest : public ::testing::Test {
 protected:
  SensorFaultTest() {
    pilot_.bring_to_hover({1.0});
    listen(0.5);
    faults_.clear();
    began_rejected_ = rejected_;
  }

  void break_sensor(SimSensor sensor, SensorFaultKind kind, double share = 1) {
    simulation_.world().break_sensor(1, sensor, {.kind = kind, .share = share});
  }
  void mend(SimSensor sensor) { break_sensor(sensor, SensorFaultKind::none); }

  void listen(double duration_s) {
    pilot_.wait_until(
        [&] {
          hear();
          return false;
        },
        duration_s);
  }
  bool listen_until(msg::EstimatorMode mode, double limit_s) {
    return pilot_.wait_until(
        [&] {
          hear();
          return mode_ == mode;
        },
        limit_s);
  }
  void hear() {
    while (const auto state = states_.take()) {
      mode_ = state->value.mode;
      for (const double v : state->value.p_WM_m) EXPECT_TRUE(std::isfinite(v));
      for (const double v : state->value.q_WM) EXPECT_TRUE(std::isfinite(v));
    }
    while (const auto wrench = wrenches_.take()) {
      for (const double v : wrench->value.force_W_N) EXPECT_TRUE(std::isfinite(v));
      for (const double v : wrench->value.moment_W_Nm) EXPECT_TRUE(std::isfinite(v));
    }
    while (const auto beat = heartbeats_.take()) {
      if (beat->value.service.view() == "estimation") rejected_ = beat->value.rejected;
      if (beat->value.service.view() == "control") flight_ = beat->value.flight_mode;
    }
    while (const auto fault = fault_.take()) {
      if (fault->value.service.view() == "estimation") faults_.push_back(fault->value);
    }
  }

  std::size_t warnings(std::string_view device, std::string_view part) const {
    std::size_t count = 0;
    for (const msg::Fault& f : faults_) {
      count += f.severity == msg::Severity::warning && f.device.view() == device &&
               f.text.view().find(part) != std::string_view::npos;
    }
    return count;
  }
  std::string told() const {
    std::string all;
    for (const msg::Fault& f : faults_) all += std::string(f.device.view()) + ": " + f.text.c_str() + "\n";
    return all;
  }
  double height_m() { return simulation_.world().truth_pose(1).p_WM_m.z(); }
  double tilt_rad() { return std::acos(std::clamp(simulation_.world().truth_pose(1).X_WB.R(2, 2), -1.0, 1.0)); }

  Simulation simulation_{row_of(1, 9)};
  Pilot pilot_{simulation_};
  bus::Reader<msg::ModuleState> states_{simulation_.listener(0).create_reader(topics::module_state)};
  bus::Reader<msg::ExternalWrench> wrenches_{simulation_.listener(0).create_reader(topics::external_wrench)};
  bus::Reader<msg::Heartbeat> heartbeats_{simulation_.listener(0).create_reader(topics::heartbeat)};
  bus::Reader<msg::Fault> fault_{simulation_.listener(0).create_reader(topics::fault)};
  msg::EstimatorMode mode_ = msg::EstimatorMode::initialising;
  msg::FlightMode flight_ = msg::FlightMode::disarmed;
  std::uint64_t rejected_ = 0, began_rejected_ = 0;
  std::vector<msg::Fault> faults_;
};

struct Break {
  SensorFaultKind kind;
  const char* name;
  const char* words;  // in the fault's text
  bool refuses;
};
const Break breaks[] = {{SensorFaultKind::silent, "silent", "silent", false},
                        {SensorFaultKind::frozen, "frozen", "frozen", true},
                        {SensorFaultKind::nan, "nan", "not finite", true},
                        {SensorFaultKind::stamp_repeated, "stamp_repeated", "repeated", true},
                        {SensorFaultKind::stamp_backward, "stamp_backward", "backward", true}};
std::string name_of_break(const ::testing::TestParamInfo<Break>& info) { return info.param.name; }

class PoseFaultTest : public SensorFaultTest, public ::testing::WithParamInterface<Break> {};

TEST_P(PoseFaultTest, DeadReckonsIsLostDescendsAndComesBack) {
  ASSERT_EQ(mode_, msg::EstimatorMode::ready);
  ASSERT_EQ(flight_, msg::FlightMode::hover);
  break_sensor(SimSensor::pose, GetParam().kind);
  EXPECT_TRUE(listen_until(msg::EstimatorMode::dead_reckoning, 0.4));
  listen(1.0);
  EXPECT_EQ(mode_, msg::EstimatorMode::dead_reckoning);
  EXPECT_EQ(flight_, msg::FlightMode::hover) << "on the IMU alone it goes on for a while";
  EXPECT_LT((simulation_.world().truth_pose(1).p_WM_m - robot::Vector3(0, 0, 1)).norm(), 0.2);
  EXPECT_TRUE(listen_until(msg::EstimatorMode::lost, 1.5));
  listen(0.3);
  EXPECT_EQ(flight_, msg::FlightMode::failsafe);
  EXPECT_GT(height_m(), 0.4) << "it descends, it does not fall";
  EXPECT_LT(tilt_rad(), 0.1);
  EXPECT_EQ(warnings("pose source", GetParam().words), 1U) << told();
  EXPECT_EQ(faults_.size(), 1U) << told();
  EXPECT_EQ(rejected_ > began_rejected_ + 100, GetParam().refuses) << rejected_ - began_rejected_;

  mend(SimSensor::pose);
  EXPECT_TRUE(listen_until(msg::EstimatorMode::ready, 1));
  listen(1.5);
  EXPECT_EQ(flight_, msg::FlightMode::hover);
  EXPECT_EQ(faults_.size(), 2U) << told();
  EXPECT_NE(faults_.back().text.view().find("good again"), std::string_view::npos) << told();
  EXPECT_EQ(pilot_.follow(pilot_.op().go_to(1, {0.5, 0, 1.2}, 0, 0.5), 15), GoalProgress::succeeded);
}

INSTANTIATE_TEST_SUITE_P(Kinds, PoseFaultTest, ::testing::ValuesIn(breaks), name_of_break);

class ImuFaultTest : public SensorFaultTest, public ::testing::WithParamInterface<Break> {};

TEST_P(ImuFaultTest, TheStateIsLostAtOnceAndTheHardwareHostTakesOver) {
  ASSERT_EQ(flight_, msg::FlightMode::hover);
  break_sensor(SimSensor::imu, GetParam().kind);
  EXPECT_TRUE(listen_until(msg::EstimatorMode::lost, 0.12));
  listen(0.1);
  EXPECT_EQ(flight_, msg::FlightMode::failsafe);
  EXPECT_EQ(warnings("imu", GetParam().words), 1U) << told();
  EXPECT_EQ(faults_.size(), 1U) << told();
  EXPECT_EQ(rejected_ > began_rejected_ + 20, GetParam().refuses) << rejected_ - began_rejected_;
  EXPECT_GT(height_m(), 0.7);
  EXPECT_LT(tilt_rad(), 0.3);

  mend(SimSensor::imu);
  EXPECT_TRUE(listen_until(msg::EstimatorMode::ready, 1));
  listen(1.5);
  EXPECT_EQ(flight_, msg::FlightMode::hover);
  EXPECT_EQ(faults_.size(), 2U) << told();
  EXPECT_EQ(pilot_.follow(pilot_.op().go_to(1, {0.5, 0, 1.2}, 0, 0.5), 15), GoalProgress::succeeded);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ImuFaultTest, ::testing::ValuesIn(breaks), name_of_break);

TEST_F(SensorFaultTest, APoseSourceThatJumpsIsDoubtedThenBelievedAndTheModuleStaysWhereItIs) {
  break_sensor(SimSensor::pose, SensorFaultKind::jump);  // 1 m along x
  listen(0.45);
  EXPECT_EQ(flight_, msg::FlightMode::hover) << "the IMU knows better for half a second";
  EXPECT_EQ(warnings("pose source", "far from what was expected"), 1U) << told();
  EXPECT_TRUE(listen_until(msg::EstimatorMode::initialising, 0.2)) << "then it begins anew";
  EXPECT_TRUE(listen_until(msg::EstimatorMode::ready, 0.5));
  listen(2);
  EXPECT_EQ(flight_, msg::FlightMode::hover);
  EXPECT_LT((simulation_.world().truth_pose(1).p_WM_m - robot::Vector3(0, 0, 1)).norm(), 0.3);
  EXPECT_EQ(pilot_.follow(pilot_.op().go_to(1, {1.5, 0, 1}, 0, 0.5), 15), GoalProgress::succeeded);
  EXPECT_NEAR(simulation_.world().truth_pose(1).p_WM_m.x(), 0.5, 0.05) << "in the frame the source has now";
}

TEST_F(SensorFaultTest, SensorsThatAreBadNowAndThenOnlyLoseThoseSamples) {
  break_sensor(SimSensor::pose, SensorFaultKind::nan, 0.2);
  break_sensor(SimSensor::imu, SensorFaultKind::nan, 0.05);
  listen(5);
  EXPECT_EQ(mode_, msg::EstimatorMode::ready);
  EXPECT_EQ(flight_, msg::FlightMode::hover);
  EXPECT_LT((simulation_.world().truth_pose(1).p_WM_m - robot::Vector3(0, 0, 1)).norm(), 0.05);
  EXPECT_NEAR(static_cast<double>(rejected_ - began_rejected_), 100 + 125, 50);
  EXPECT_EQ(faults_.size(), 2U) << told();
}

TEST(FrozenSensorTest, NegativeControlWithoutTheCheckAFrozenPoseIsBelieved) {
  // The frozen pose says that the module stands still, and wherever the wind takes it, it goes.
  const auto strays_m = [](bool refuses) {
    SimulationConfig config = row_of(1, 9);
    config.module.estimation.refuses_frozen = refuses;
    Simulation simulation(config);
    Pilot pilot(simulation);
    pilot.bring_to_hover({1.5});
    simulation.world().set_wind({3, 0, 0});
    simulation.world().break_sensor(1, SimSensor::pose, {.kind = SensorFaultKind::frozen});
    pilot.wait(2);
    return (simulation.world().truth_pose(1).p_WM_m - robot::Vector3(0, 0, 1.5)).norm();
  };
  const double refused_m = strays_m(true), believed_m = strays_m(false);
  EXPECT_GT(believed_m, 2 * refused_m) << refused_m;
}

}  // namespace
}  // namespace eciton::deploy
