// Two modules that boot with one id, each with its radio and its control: both refuse to arm and say why.
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "core/bus/vendors/sim_network/sim_network.hpp"
#include "core/robot/airframe.hpp"
#include "services/control/control_service.hpp"
#include "services/radio/radio_service.hpp"

namespace eciton::radio {
namespace {

using bus::sim_network::Network;

constexpr std::uint32_t swarm_domain = 1;

bus::ParticipantConfig on(std::uint32_t domain, const std::string& name) {
  return {.vendor = "sim_network", .domain = domain, .name = name, .network_interface = "lo", .peers = {}};
}

/// A module on the ground: radio, control, and what its estimation and its hardware host say.
struct Module {
  Module(std::uint32_t domain_of_ring, std::uint32_t module_id, std::uint64_t incarnation)
      : domain(domain_of_ring),
        id(module_id),
        ring(on(domain, "radio")),
        swarm(on(swarm_domain, "radio of " + std::to_string(domain)), &ring.waker()),
        radio(ring, swarm, {.module_id = id, .name = "m", .airframe = "legion", .incarnation = incarnation}),
        services(on(domain, "control")),
        control(services, {.module_id = id}, robot::legion()),
        rest(on(domain, "rest")) {}

  void step(TimePoint now) {
    state.write({.module_id = id, .stamp_ns = to_ns(now), .mode = msg::EstimatorMode::ready, .q_WM = {1, 0, 0, 0}});
    rotors.write({.module_id = id, .stamp_ns = to_ns(now), .armed = false});
    Network::of(domain).advance(now);
    ring.set_now(now), swarm.set_now(now), services.set_now(now), rest.set_now(now);
    radio.step(now);
    control.step(now);
    Network::of(domain).advance(now);
    while (const auto fault = faults.take()) told += std::string(fault->value.text.view()) + "\n";
    while (const auto heard = status.take()) answer = heard->value;
  }

  std::uint32_t domain, id;
  bus::Participant ring, swarm;
  RadioService radio;
  bus::Participant services;
  control::ControlService control;
  bus::Participant rest;
  bus::Writer<msg::ModuleState> state = rest.create_writer(topics::module_state);
  bus::Writer<msg::RotorState> rotors = rest.create_writer(topics::rotor_state);
  bus::Reader<msg::Fault> faults = rest.create_reader(topics::fault);
  bus::Reader<msg::GoalStatus> status = rest.create_reader(topics::goal_status);
  std::string told;
  std::optional<msg::GoalStatus> answer;
};

class DuplicateBootTest : public ::testing::Test {
 protected:
  DuplicateBootTest() {
    Network::reset_all();
    for (const std::uint32_t domain : {swarm_domain, 11u, 12u})
      Network::of(domain).configure(1, bus::sim_network::Pacing::virtual_time);
  }
  ~DuplicateBootTest() override {
    a_.reset(), b_.reset(), request_.reset(), operator_.reset();
    Network::reset_all();
  }
  void boot(std::uint32_t other_id) {
    a_.emplace(11, 1, 100);
    b_.emplace(12, other_id, 200);
    operator_.emplace(on(swarm_domain, "operator"));
    request_.emplace(operator_->create_writer(topics::mode_request));
  }
  void run(Duration span) {
    for (const TimePoint end = now_ + span; now_ < end; now_ += 10ms) {
      Network::of(swarm_domain).advance(now_);
      a_->step(now_), b_->step(now_);
    }
  }
  void arm(std::uint32_t id, std::uint64_t goal) {
    request_->write(
        {.module_id = id, .stamp_ns = to_ns(now_), .correlation_id = goal, .action = msg::ModeAction::arm});
    run(100ms);
  }

  TimePoint now_{10000s};
  std::optional<bus::Participant> operator_;
  std::optional<bus::Writer<msg::ModeRequest>> request_;
  std::optional<Module> a_, b_;
};

TEST_F(DuplicateBootTest, BothRefuseToArmAndSayWhy) {
  boot(1);
  run(1s);  // beacons that take turns: known well before an operator is
  arm(1, 5);
  for (const Module* module : {&*a_, &*b_}) {
    ASSERT_TRUE(module->answer);
    EXPECT_EQ(module->answer->phase, msg::GoalPhase::refused);
    EXPECT_EQ(module->answer->reason.view(), "another module has this id; change one");
    EXPECT_NE(module->told.find("another module with our id is heard: give one of them another id; we refuse to arm"),
              std::string::npos)
        << module->told;
  }
}

TEST_F(DuplicateBootTest, WithIdsOfTheirOwnBothArm) {
  boot(2);
  run(1s);
  arm(1, 5), arm(2, 6);
  for (const Module* module : {&*a_, &*b_}) {
    ASSERT_TRUE(module->answer);
    EXPECT_EQ(module->answer->phase, msg::GoalPhase::succeeded) << module->answer->reason.view();
    EXPECT_EQ(module->told, "");
  }
}

TEST_F(DuplicateBootTest, ARestartOfTheRadioIsNoOtherModule) {
  boot(2);
  run(1s);
  a_.reset();
  a_.emplace(11, 1, 101);
  run(10s);
  arm(1, 7);
  EXPECT_EQ(a_->answer->phase, msg::GoalPhase::succeeded) << a_->answer->reason.view();
  EXPECT_EQ(a_->told, "");
}

}  // namespace
}  // namespace eciton::radio
