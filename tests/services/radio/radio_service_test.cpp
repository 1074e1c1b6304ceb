// The radio between two simulated rings in virtual time: what crosses, how often, and what stays.
#include "services/radio/radio_service.hpp"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <vector>

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
    bus::Writer<msg::Beacon> peer_beacon = peer.create_writer(topics::beacon);
    bus::Reader<msg::RadioState> radio_state = services.create_reader(topics::radio_state);
    bus::Reader<msg::ModuleInfo> info_outside = ear.create_reader(topics::module_info);
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
      while (const auto heard = rings_->beacon_outside.take()) {
        if (heard->value.module_id != own_id) continue;
        ++counts.beacons;
        beacon_ = heard->value;
      }
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
  msg::Beacon beacon_;  // the last one of module 1
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

TEST_F(RadioServiceTest, EchoesOnePeerByTurnsWhileIdleAndAllNearOne) {
  Rings& rings = start();
  run(5s);  // past the beacons that follow the start
  std::map<std::uint32_t, int> echoed;
  for (int second = 0; second < 24; ++second) {
    for (const std::uint32_t id : {2u, 5u, 9u}) {
      rings.peer_beacon.write(msg::Beacon{.module_id = id, .stamp_ns = to_ns(now_) + id});
    }
    if (run(1s).beacons == 0) continue;
    ASSERT_EQ(beacon_.peers.size(), 1u) << "each one is a sixth of the beacon, to every peer";
    const msg::PeerEcho& echo = beacon_.peers[0];
    ++echoed[echo.module_id];
    EXPECT_EQ(echo.stamp_ns % 1000, echo.module_id) << "the stamp as that peer gave it";
    EXPECT_LE(echo.received_ns, beacon_.stamp_ns);
    EXPECT_GE(echo.received_ns, echo.stamp_ns - echo.module_id);
  }
  EXPECT_EQ(echoed, (std::map<std::uint32_t, int>{{2, 4}, {5, 4}, {9, 4}}));
  dock(msg::DockingPhase::approach);
  run(2s);
  EXPECT_EQ(beacon_.peers.size(), 3u);
  run(30s);
  EXPECT_EQ(beacon_.peers.size(), 0u) << "peers that are gone are echoed no more";
}

TEST_F(RadioServiceTest, TellsItsServicesHowThePeersClocksStand) {
  Rings& rings = start();
  run(5s);
  constexpr Duration ahead = 37s;  // of the peer's clock
  const auto sent = TimePoint(from_ns(beacon_.stamp_ns));
  // Received 4 ms after it was sent, answered 6 ms later, on the peer's clock.
  msg::Beacon answer{.module_id = peer_id, .stamp_ns = to_ns(sent + 10ms + ahead)};
  answer.peers.push_back(
      {.module_id = own_id, .stamp_ns = beacon_.stamp_ns, .received_ns = to_ns(sent + 4ms + ahead)});
  const Duration round_trip = now_ - sent - 6ms;
  rings.peer_beacon.write(answer);
  run(20ms);
  std::optional<msg::RadioState> state;
  while (const auto heard = rings.radio_state.take()) state = heard->value;
  ASSERT_TRUE(state);
  ASSERT_EQ(state->peers.size(), 1u);
  EXPECT_EQ(state->peers[0].module_id, peer_id);
  EXPECT_NEAR(to_s(Duration{state->peers[0].offset_ns} - ahead), 0, to_s(Duration{state->peers[0].offset_bound_ns}));
  EXPECT_NEAR(to_s(Duration{state->peers[0].offset_bound_ns}), to_s(round_trip) / 2, 0.011) << "a step of the radio";
  EXPECT_EQ(state->dropped, 0u);
  EXPECT_GT(state->sent, 200u);
}

/// A service of module 1 that beats, or does not, while the radio steps.
class RadioWatchTest : public RadioServiceTest {
 protected:
  void start_watch(bool watches) {
    RadioConfig config;
    config.watches = watches;
    Rings& rings = start(config);
    beats_.emplace(rings.services.create_writer(topics::heartbeat));
    faults_.emplace(rings.services.create_reader(topics::fault));
  }
  void beat_for(Duration span, msg::Lifecycle lifecycle = msg::Lifecycle::active) {
    for (const TimePoint end = now_ + span; now_ < end;) {
      msg::Heartbeat beat{.module_id = own_id, .service_key = 5, .stamp_ns = to_ns(now_), .service = "control"};
      beat.lifecycle = lifecycle;
      beats_->write(beat);
      run(10ms);
    }
  }
  std::vector<msg::Fault> told() {
    std::vector<msg::Fault> faults;
    while (const auto fault = faults_->take()) faults.push_back(fault->value);
    return faults;
  }

  std::optional<bus::Writer<msg::Heartbeat>> beats_;
  std::optional<bus::Reader<msg::Fault>> faults_;
};

TEST_F(RadioWatchTest, TellsOfAServiceThatFallsSilentAndOfItsReturn) {
  start_watch(true);
  beat_for(2s);
  EXPECT_TRUE(told().empty());
  run(200ms);
  std::vector<msg::Fault> faults = told();
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].severity, msg::Severity::error);
  EXPECT_EQ(faults[0].service.view(), "radio");
  EXPECT_EQ(faults[0].device.view(), "control");
  EXPECT_NE(faults[0].text.view().find("control has been silent for 50 ms"), std::string_view::npos)
      << faults[0].text.view() << ": the first step of the radio, every 10 ms here, after 46 ms";
  beat_for(50ms);
  faults = told();
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].severity, msg::Severity::info);
  EXPECT_NE(faults[0].text.view().find("control is back: it was silent for 0.2"), std::string_view::npos)
      << faults[0].text.view();
}

TEST_F(RadioWatchTest, DoesNotMissAServiceThatSaidFarewell) {
  start_watch(true);
  beat_for(2s);
  beat_for(10ms, msg::Lifecycle::finalized);
  run(1s);
  EXPECT_TRUE(told().empty());
}

TEST_F(RadioWatchTest, LooksAwayWhereHeartbeatsDoNotComeByTheWallClock) {
  start_watch(false);
  beat_for(2s);
  run(1s);
  EXPECT_TRUE(told().empty());
}

TEST_F(RadioServiceTest, IntroducesItsModuleOnce) {
  RadioConfig config;
  config.name = "left";
  config.airframe = "legion";
  Rings& rings = start(config);
  run(10s);
  int introductions = 0;
  while (const auto heard = rings.info_outside.take()) {
    ++introductions;
    EXPECT_EQ(heard->value.module_id, own_id);
    EXPECT_EQ(heard->value.name, "left");
    EXPECT_EQ(heard->value.airframe, "legion");
  }
  EXPECT_EQ(introductions, 1);
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
