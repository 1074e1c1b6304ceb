// The radio between two simulated rings in virtual time: what crosses, how often, and what stays.
#include "services/radio/radio_service.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "core/bus/vendors/sim_network/sim_network.hpp"

namespace eciton::radio {
namespace {

using bus::sim_network::Network;

constexpr std::uint32_t ring_domain = 11, swarm_domain = 1, own_id = 1, peer_id = 2;

/// Module 1's ring at 500 Hz and its radio at 100 Hz, with a peer and an ear on the swarm ring.
class RadioServiceTest : public ::testing::Test {
 protected:
  struct Rings {
    explicit Rings(const RadioConfig& config) : radio(ring, swarm, config) {}
    bus::Participant ring{on(ring_domain, "radio")};
    bus::Participant swarm{on(swarm_domain, "radio"), &ring.waker()};
    RadioService radio;
    bus::Participant services{on(ring_domain, "services")};
    bus::Writer<msg::ModuleState> state = services.create_writer(topics::module_state);
    bus::Writer<msg::ExternalWrench> wrench = services.create_writer(topics::external_wrench);
    bus::Writer<msg::JointState> joints = services.create_writer(topics::joint_state);
    bus::Writer<msg::DockingState> docking = services.create_writer(topics::docking_state);
    bus::Writer<msg::FlightGoal> goal_inside = services.create_writer(topics::flight_goal);
    bus::Reader<msg::ModuleState> state_inside = services.create_reader(topics::module_state);
    bus::Reader<msg::FlightGoal> goal_heard = services.create_reader(topics::flight_goal);
    bus::Participant ear{on(swarm_domain, "ear")};
    bus::Reader<msg::ModuleState> state_outside = ear.create_reader(topics::module_state);
    bus::Reader<msg::ExternalWrench> wrench_outside = ear.create_reader(topics::external_wrench);
    bus::Reader<msg::JointState> joints_outside = ear.create_reader(topics::joint_state);
    bus::Reader<msg::Beacon> beacon_outside = ear.create_reader(topics::beacon);
    bus::Reader<msg::FlightGoal> goal_outside = ear.create_reader(topics::flight_goal);
    bus::Participant peer{on(swarm_domain, "peer")};
    bus::Writer<msg::ModuleState> peer_state = peer.create_writer(topics::module_state);
    bus::Writer<msg::FlightGoal> peer_goal = peer.create_writer(topics::flight_goal);
  };
  struct Counts {
    int states = 0, wrenches = 0, joints = 0, peer_states = 0, beacons = 0;
  };

  RadioServiceTest() {
    Network::reset_all();
    for (const std::uint32_t domain : {ring_domain, swarm_domain})
      Network::of(domain).configure(1, bus::sim_network::Pacing::virtual_time);
  }
  ~RadioServiceTest() override {
    rings_.reset();
    Network::reset_all();
  }

  static bus::ParticipantConfig on(std::uint32_t domain, const std::string& name) {
    return {.vendor = "sim_network", .domain = domain, .name = name, .network_interface = "lo", .peers = {}};
  }

  Rings& start(RadioConfig config = {}) {
    config.module_id = own_id;
    return rings_.emplace(config);
  }

  /// For so long; what the swarm heard meanwhile, of module 1 and of the peer.
  Counts run(Duration span) {
    Counts counts;
    for (const TimePoint end = now_ + span; now_ < end; now_ += 2ms) {
      const std::int64_t stamp_ns = to_ns(now_ + clock_ahead_);
      rings_->state.write(msg::ModuleState{.module_id = own_id, .stamp_ns = stamp_ns});
      rings_->wrench.write(msg::ExternalWrench{.module_id = own_id, .stamp_ns = stamp_ns});
      rings_->joints.write(msg::JointState{.module_id = own_id, .stamp_ns = stamp_ns});
      for (const std::uint32_t domain : {ring_domain, swarm_domain}) Network::of(domain).advance(now_);
      if (to_ns(now_) % 10'000'000 == 0) rings_->radio.step(now_ + clock_ahead_);
      for (const std::uint32_t domain : {ring_domain, swarm_domain}) Network::of(domain).advance(now_);
      while (const auto heard = rings_->state_outside.take())
        ++(heard->value.module_id == own_id ? counts.states : counts.peer_states);
      while (rings_->wrench_outside.take()) ++counts.wrenches;
      while (rings_->joints_outside.take()) ++counts.joints;
      while (rings_->beacon_outside.take()) ++counts.beacons;
    }
    return counts;
  }
  void dock(msg::DockingPhase phase) {
    rings_->docking.write(msg::DockingState{.module_id = own_id, .stamp_ns = to_ns(now_), .phase = phase});
    run(20ms);
  }

  TimePoint now_{10000s};
  Duration clock_ahead_{};  // of the module's clock
  std::optional<Rings> rings_;
};

TEST_F(RadioServiceTest, ThinsOutTheStateOfItsModule) {
  start();
  const Counts counts = run(10s);
  EXPECT_NEAR(counts.states, 500, 2);  // 50 Hz of the 500
  EXPECT_EQ(counts.wrenches, 0) << "nobody is near";
  EXPECT_EQ(counts.joints, 0);
}

TEST_F(RadioServiceTest, FollowsTheConfiguredRates) {
  RadioConfig config;
  config.state_rate_Hz = 20;
  config.joint_rate_Hz = 10;
  config.wrench_rate_Hz = 25;
  start(config);
  dock(msg::DockingPhase::approach);
  const Counts counts = run(10s);
  EXPECT_NEAR(counts.states, 200, 2);
  EXPECT_NEAR(counts.joints, 100, 2);
  EXPECT_NEAR(counts.wrenches, 250, 2);
}

TEST_F(RadioServiceTest, SendsWrenchesAndJointsOnlyNearAPeer) {
  start();
  dock(msg::DockingPhase::approach);
  const Counts near = run(10s);
  EXPECT_NEAR(near.wrenches, 1000, 2);
  EXPECT_NEAR(near.joints, 500, 2);
  dock(msg::DockingPhase::idle);
  const Counts apart = run(10s);
  EXPECT_EQ(apart.wrenches, 0);
  EXPECT_EQ(apart.joints, 0);
  EXPECT_NEAR(apart.states, 500, 2);
}

TEST_F(RadioServiceTest, SurvivesAClockSetBack) {
  start();
  run(1s);
  clock_ahead_ = -1h;
  // Without care everything would be held back for an hour.
  const Counts counts = run(10s);
  EXPECT_NEAR(counts.states, 500, 2);
  EXPECT_GE(counts.beacons, 5);
}

TEST_F(RadioServiceTest, BringsInThePeersStatesButNeverSendsThemBack) {
  Rings& rings = start();
  int inside = 0, outside = 0;
  for (int k = 0; k < 100; ++k) {
    rings.peer_state.write(msg::ModuleState{.module_id = peer_id, .stamp_ns = to_ns(now_)});
    outside += run(20ms).peer_states;
    while (const auto heard = rings.state_inside.take()) inside += heard->value.module_id == peer_id;
  }
  EXPECT_EQ(inside, 100);
  EXPECT_EQ(outside, 100) << "each once: from the peer itself";
}

TEST_F(RadioServiceTest, BringsInGoalsWhoeverTheyAreForAndSendsNone) {
  Rings& rings = start();
  rings.peer_goal.write(msg::FlightGoal{.module_id = peer_id, .stamp_ns = to_ns(now_), .correlation_id = 5});
  rings.goal_inside.write(msg::FlightGoal{.module_id = 9, .stamp_ns = to_ns(now_), .correlation_id = 6});
  run(100ms);
  bool heard_inside = false, heard_outside = false;
  while (const auto goal = rings.goal_heard.take()) heard_inside |= goal->value.correlation_id == 5;
  while (const auto goal = rings.goal_outside.take()) heard_outside |= goal->value.correlation_id == 6;
  EXPECT_TRUE(heard_inside);
  EXPECT_FALSE(heard_outside);
}

}  // namespace
}  // namespace eciton::radio
