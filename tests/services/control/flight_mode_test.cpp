// Every request in every mode, and what happens by itself.
#include "services/control/flight_mode.hpp"

#include <gtest/gtest.h>

#include <string>

namespace eciton::control {
namespace {

constexpr FlightMode modes[] = {FlightMode::disarmed, FlightMode::armed, FlightMode::takeoff,  FlightMode::hover,
                                FlightMode::move,     FlightMode::land,  FlightMode::failsafe, FlightMode::stopped};
constexpr FlightRequest requests[] = {FlightRequest::arm,     FlightRequest::disarm, FlightRequest::stop,
                                      FlightRequest::takeoff, FlightRequest::go_to,  FlightRequest::land};

FlightConditions good() {
  FlightConditions c;
  c.state_ready = c.state_usable = true;
  c.state_age_s = 0.002;
  c.state_good_s = 10;
  return c;
}

TEST(FlightModeTest, EveryRequestInEveryModeIsGrantedOrRefusedAsTabulated) {
  //                          arm   disarm stop  takeoff goto  land
  const bool expected[8][6] = {{true, true, true, false, false, false},    // disarmed
                               {true, true, true, true, false, false},     // armed
                               {false, false, true, false, false, true},   // takeoff
                               {false, false, true, false, true, true},    // hover
                               {false, false, true, false, true, true},    // move
                               {false, false, true, false, false, true},   // land
                               {false, false, true, false, false, false},  // failsafe
                               {false, true, true, false, false, false}};  // stopped
  for (int m = 0; m < 8; ++m) {
    for (int r = 0; r < 6; ++r) {
      const FlightDecision d = decide(modes[m], requests[r], good());
      EXPECT_EQ(d.accepted, expected[m][r]) << name(modes[m]) << ", request " << r;
      if (!d.accepted) {
        EXPECT_EQ(d.mode, modes[m]);
        EXPECT_FALSE(std::string(d.reason).empty());
      }
    }
  }
  EXPECT_EQ(decide(FlightMode::armed, FlightRequest::takeoff, good()).mode, FlightMode::takeoff);
  EXPECT_EQ(decide(FlightMode::hover, FlightRequest::go_to, good()).mode, FlightMode::move);
  EXPECT_EQ(decide(FlightMode::takeoff, FlightRequest::land, good()).mode, FlightMode::land);
  EXPECT_EQ(decide(FlightMode::stopped, FlightRequest::disarm, good()).mode, FlightMode::disarmed);
}

TEST(FlightModeTest, StopIsGrantedWhateverTheConditions) {
  for (const FlightMode mode : modes) {
    EXPECT_EQ(decide(mode, FlightRequest::stop, {}).mode, FlightMode::stopped);
    EXPECT_FALSE(powered(FlightMode::stopped));
  }
}

TEST(FlightModeTest, ArmingNeedsAReadyFreshStateAndAnIdOfItsOwn) {
  FlightConditions c = good();
  c.state_age_s = 0.2;
  EXPECT_NE(std::string(decide(FlightMode::disarmed, FlightRequest::arm, c).reason).find("fresh"), std::string::npos);
  c = good();
  c.state_ready = false;
  EXPECT_NE(std::string(decide(FlightMode::disarmed, FlightRequest::arm, c).reason).find("ready"), std::string::npos);
  c = good();
  c.duplicate_id = true;
  EXPECT_FALSE(decide(FlightMode::disarmed, FlightRequest::arm, c).accepted);
  EXPECT_TRUE(decide(FlightMode::hover, FlightRequest::land, c).accepted);  // met in flight: only a warning
}

TEST(FlightModeTest, DeadReckoningFliesOnButBeginsNothingNew) {
  FlightConditions c = good();
  c.state_ready = false;
  EXPECT_EQ(advance(FlightMode::hover, c).mode, FlightMode::hover);
  EXPECT_FALSE(decide(FlightMode::hover, FlightRequest::go_to, c).accepted);
  EXPECT_TRUE(decide(FlightMode::hover, FlightRequest::land, c).accepted);
}

TEST(FlightModeTest, ALostStateInTheAirIsFailsafeAndHoverReturnsOnceItIsGoodForAWhile) {
  for (const FlightMode mode : {FlightMode::takeoff, FlightMode::hover, FlightMode::move, FlightMode::land}) {
    FlightConditions c = good();
    c.state_age_s = 0.101;
    EXPECT_EQ(advance(mode, c).mode, FlightMode::failsafe);
    c = good();
    c.state_usable = false;
    EXPECT_EQ(advance(mode, c).mode, FlightMode::failsafe);
  }
  FlightConditions back = good();
  back.state_good_s = 0.1;
  EXPECT_EQ(advance(FlightMode::failsafe, back).mode, FlightMode::failsafe);
  back.state_good_s = 0.35;
  EXPECT_EQ(advance(FlightMode::failsafe, back).mode, FlightMode::hover);
  back.emergency_descent_over = true;
  EXPECT_EQ(advance(FlightMode::failsafe, back).mode, FlightMode::disarmed);
}

TEST(FlightModeTest, ALostStateOnTheGroundDisarms) {
  EXPECT_EQ(advance(FlightMode::armed, {}).mode, FlightMode::disarmed);
  EXPECT_EQ(advance(FlightMode::disarmed, {}).mode, FlightMode::disarmed);
  EXPECT_EQ(advance(FlightMode::stopped, good()).mode, FlightMode::stopped);
}

TEST(FlightModeTest, ArrivingHoversAndLandingDisarms) {
  FlightConditions c = good();
  c.trajectory_finished = true;
  EXPECT_EQ(advance(FlightMode::takeoff, c).mode, FlightMode::hover);
  EXPECT_EQ(advance(FlightMode::move, c).mode, FlightMode::hover);
  EXPECT_EQ(advance(FlightMode::land, c).mode, FlightMode::land);  // the way down may end above the ground
  c.landed = true;
  EXPECT_EQ(advance(FlightMode::land, c).mode, FlightMode::disarmed);
}

TEST(FlightModeTest, AnAgeThatIsNotANumberIsTooOld) {
  FlightConditions c = good();
  c.state_age_s = std::stod("nan");
  EXPECT_EQ(advance(FlightMode::hover, c).mode, FlightMode::failsafe);
}

TEST(TouchdownTest, LittleThrustAndNoFallForAWhile) {
  TouchdownDetector detector;
  for (int k = 0; k < 150; ++k) EXPECT_FALSE(detector.update(20, 40, 0, 0.002));
  EXPECT_FALSE(detector.update(20, 40, -0.5, 0.002));  // falls
  bool landed = false;
  for (int k = 0; k < 201; ++k) landed = detector.update(20, 40, 0, 0.002);
  EXPECT_TRUE(landed);
  EXPECT_FALSE(detector.update(39, 40, 0, 0.002));  // hovering
}

}  // namespace
}  // namespace eciton::control
