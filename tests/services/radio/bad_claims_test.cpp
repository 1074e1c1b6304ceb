// Bad link claims on the swarm ring: module 1's radio and what keeps its chain are real, module 2's radio speaks
// beside somebody who is nobody's radio. No bad claim changes the chain; each is counted for what it is.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <optional>

#include "core/bus/vendors/sim_network/sim_network.hpp"
#include "services/docking/membership_service.hpp"
#include "services/radio/radio_service.hpp"

namespace eciton::radio {
namespace {

using bus::sim_network::Network;

constexpr std::uint32_t ring_domain = 11, swarm_domain = 1, own_id = 1, peer_id = 2;
constexpr std::uint64_t later = 1'000'000;  // an incarnation that beats every true one

bus::ParticipantConfig on(std::uint32_t domain, const std::string& name) {
  return {.vendor = "sim_network", .domain = domain, .name = name, .network_interface = "lo", .peers = {}};
}

struct Rings {
  bus::Participant ring{on(ring_domain, "radio")};
  bus::Participant swarm{on(swarm_domain, "radio"), &ring.waker()};
  RadioService radio{ring, swarm, {.module_id = own_id, .name = "m1", .airframe = "legion", .incarnation = 7}};
  bus::Participant services{on(ring_domain, "docking")};
  docking::Membership membership{services, {.module_id = own_id, .incarnation = 7}};
  bus::Writer<msg::LatchState> latch = services.create_writer(topics::latch_state);
  bus::Reader<msg::RadioState> radio_state = services.create_reader(topics::radio_state);
  bus::Reader<msg::Fault> faults = services.create_reader(topics::fault);
  bus::Participant peer{on(swarm_domain, "m2/radio")};
  bus::Writer<msg::Beacon> peer_beacon = peer.create_writer(topics::beacon);
  bus::Writer<msg::LinkClaim> peer_claim = peer.create_writer(topics::link_claim);
  bus::Writer<msg::ChainView> peer_view = peer.create_writer(topics::chain_view);
  bus::Participant nobody{on(swarm_domain, "nobody")};
  bus::Writer<msg::LinkClaim> forged_claim = nobody.create_writer(topics::link_claim);
  bus::RawWriter forged_bytes = nobody.create_raw_writer(bus::info(topics::link_claim));
};

class BadClaimsTest : public ::testing::Test {
 protected:
  BadClaimsTest() {
    Network::reset_all();
    for (const std::uint32_t domain : {ring_domain, swarm_domain})
      Network::of(domain).configure(1, bus::sim_network::Pacing::virtual_time);
    rings_.emplace();
  }
  ~BadClaimsTest() override {
    rings_.reset();
    Network::reset_all();
  }

  void run(Duration span, bool peer_beacons = true) {
    for (const TimePoint end = now_ + span; now_ < end; now_ += 10ms) {
      if (peer_beacons && to_ns(now_) % 500'000'000 == 0) {
        rings_->peer_beacon.write(msg::Beacon{.module_id = peer_id, .stamp_ns = to_ns(now_), .incarnation = 5});
      }
      for (const auto& domain : {swarm_domain, ring_domain}) Network::of(domain).advance(now_);
      rings_->swarm.set_now(now_), rings_->ring.set_now(now_), rings_->services.set_now(now_);
      rings_->radio.step(now_);
      for (const auto& domain : {swarm_domain, ring_domain}) Network::of(domain).advance(now_);
      const chain::PeerStatus peer{.module = peer_id, .fresh = true, .clock_offset = Duration{}};
      rings_->membership.update(now_, {&peer, 1});
      while (const auto state = rings_->radio_state.take()) state_ = state->value;
      while (const auto fault = rings_->faults.take()) told_ += std::string(fault->value.text.view()) + "\n";
    }
  }
  /// What module 2 says of its female port when our male one sits in it.
  msg::LinkClaim true_claim() const {
    return {.module_id = peer_id,
            .port = 1,
            .stamp_ns = to_ns(now_),
            .incarnation = 5,
            .sequence_number = 2,
            .withdrawn = false,
            .peer_id = own_id,
            .peer_port = 0,
            .latch = msg::LatchStatus::latched};
  }
  msg::LinkClaim changed(const std::function<void(msg::LinkClaim&)>& change) const {
    msg::LinkClaim claim = true_claim();
    change(claim);
    return claim;
  }
  /// Links our port 0 with module 2's port 1.
  void link() {
    run(20ms);
    rings_->membership.expect(0, peer_id, 1);
    rings_->latch.write(
        {.module_id = own_id, .port = 0, .stamp_ns = to_ns(now_), .status = msg::LatchStatus::latched});
    rings_->latch.write({.module_id = own_id, .port = 1, .stamp_ns = to_ns(now_), .status = msg::LatchStatus::open});
    rings_->peer_claim.write(true_claim());
    run(100ms);
    ASSERT_TRUE(rings_->membership.link_of(0));
  }
  std::array<std::uint64_t, 4> counts() const {
    return {state_.claims_malformed, state_.claims_foreign, state_.claims_unknown, state_.claims_no_port};
  }
  std::uint64_t in_heartbeat() const {
    msg::Heartbeat beat;
    rings_->radio.describe(beat);
    return beat.rejected;
  }
  std::uint64_t revision() const { return rings_->membership.claims().revision(); }

  TimePoint now_{10000s};
  std::optional<Rings> rings_;
  msg::RadioState state_;
  std::string told_;
};

using Counts = std::array<std::uint64_t, 4>;

// The negative control of all that follows: what differs from a true claim is only what is wrong with it.
TEST_F(BadClaimsTest, TrueClaimsMakeAndUnmakeALinkAndCountNothing) {
  link();
  EXPECT_EQ(rings_->membership.link_of(0)->peer, peer_id);
  rings_->peer_claim.write(changed(
      [](msg::LinkClaim& c) { c.sequence_number = 3, c.withdrawn = true, c.latch = msg::LatchStatus::open; }));
  run(500ms);
  EXPECT_FALSE(rings_->membership.link_of(0)) << "the peer's own withdrawal does";
  EXPECT_EQ(counts(), Counts{});
  EXPECT_EQ(in_heartbeat(), 0u);
  EXPECT_EQ(told_, "");
}

TEST_F(BadClaimsTest, OfAWriterThatIsNotTheModulesRadio) {
  link();
  const std::uint64_t before = revision();
  // It would cut the link: a later word of module 2, that it has let go.
  rings_->forged_claim.write(changed(
      [](msg::LinkClaim& c) { c.incarnation = later, c.withdrawn = true, c.latch = msg::LatchStatus::open; }));
  run(500ms);
  EXPECT_TRUE(rings_->membership.link_of(0));
  EXPECT_EQ(revision(), before);
  EXPECT_EQ(counts(), (Counts{0, 1, 0, 0}));
  EXPECT_NE(told_.find("link claim of module 2 refused: not written by that module's radio; 1 such so far"),
            std::string::npos)
      << told_;
  // And one in our own name.
  rings_->forged_claim.write(
      changed([](msg::LinkClaim& c) { c.module_id = own_id, c.peer_id = peer_id, c.incarnation = later; }));
  run(500ms);
  EXPECT_EQ(revision(), before);
  EXPECT_EQ(counts(), (Counts{0, 2, 0, 0}));
  EXPECT_EQ(in_heartbeat(), 2u);
  // The radio itself is believed as before.
  rings_->peer_claim.write(changed([](msg::LinkClaim& c) { c.sequence_number = 3; }));
  run(500ms);
  EXPECT_GT(revision(), before);
  EXPECT_EQ(counts(), (Counts{0, 2, 0, 0}));
}

TEST_F(BadClaimsTest, Malformed) {
  link();
  const std::uint64_t before = revision();
  for (const auto& change : std::initializer_list<void (*)(msg::LinkClaim&)>{
           [](msg::LinkClaim& c) { c.incarnation = later, c.latch = msg::LatchStatus::open; },
           [](msg::LinkClaim& c) { c.incarnation = later, c.peer_id = peer_id; },
           [](msg::LinkClaim& c) { c.incarnation = later, c.peer_id = 4000; },
           [](msg::LinkClaim& c) { c.incarnation = later, c.sequence_number = 0; },
           [](msg::LinkClaim& c) { c.incarnation = later, c.withdrawn = true; }}) {
    rings_->peer_claim.write(changed(change));
    run(20ms);
  }
  run(500ms);
  EXPECT_EQ(counts(), (Counts{5, 0, 0, 0}));
  EXPECT_EQ(revision(), before);
  EXPECT_TRUE(rings_->membership.link_of(0));
}

TEST_F(BadClaimsTest, BytesThatAreNoClaim) {
  link();
  const std::uint64_t before = revision();
  std::array<std::uint8_t, bus::TypeTraits<msg::LinkClaim>::size_max> room{};
  const std::size_t size = bus::encode(true_claim(), room);
  std::vector<std::uint8_t> odd(room.begin(), room.begin() + size);
  odd[odd.size() - 4] = 77;  // the latch: there are three of its words
  rings_->forged_bytes.write(odd);
  run(500ms);
  EXPECT_EQ(counts(), (Counts{1, 0, 0, 0}));
  odd.assign(room.begin(), room.begin() + 20);  // cut off behind its key
  rings_->forged_bytes.write(odd);
  run(500ms);
  EXPECT_EQ(counts(), (Counts{2, 0, 0, 0}));
  EXPECT_EQ(revision(), before);
}

TEST_F(BadClaimsTest, OfUnknownModules) {
  link();
  const std::uint64_t before = revision();
  // As many as the bus lets through beside the true ones.
  for (std::uint32_t id = 10; id < 60; ++id) {
    rings_->forged_claim.write(changed([&](msg::LinkClaim& c) { c.module_id = id; }));
    run(10ms);
  }
  run(7s);
  EXPECT_EQ(revision(), before);
  EXPECT_EQ(counts(), (Counts{0, 0, 50, 0}));
  EXPECT_NE(told_.find("no beacon of that module is heard"), std::string::npos) << told_;
  rings_->peer_claim.write(changed([](msg::LinkClaim& c) { c.sequence_number = 3; }));
  run(100ms);
  EXPECT_GT(revision(), before) << "the true ones go on";
}

TEST_F(BadClaimsTest, AClaimThatComesBeforeItsModulesBeaconWaitsForIt) {
  rings_->peer_claim.write(true_claim());
  run(3s, false);
  EXPECT_EQ(rings_->membership.claims().find(peer_id, 1), nullptr);
  run(600ms);
  EXPECT_NE(rings_->membership.claims().find(peer_id, 1), nullptr);
  EXPECT_EQ(counts(), Counts{}) << "that is no fault";
  // Of somebody else's making it does not get in then either.
  rings_->forged_claim.write(changed([](msg::LinkClaim& c) { c.module_id = 3; }));
  run(1s);
  rings_->peer_beacon.write(msg::Beacon{.module_id = 3, .stamp_ns = to_ns(now_), .incarnation = 5});
  run(500ms);
  EXPECT_EQ(rings_->membership.claims().find(3, 1), nullptr);
  EXPECT_EQ(counts(), (Counts{0, 1, 0, 0}));
}

TEST_F(BadClaimsTest, ForPortsThatDoNotExist) {
  link();
  const std::uint64_t before = revision();
  rings_->peer_claim.write(changed([](msg::LinkClaim& c) { c.port = 2; }));
  rings_->peer_claim.write(changed([](msg::LinkClaim& c) { c.port = 0, c.peer_port = 2; }));
  run(500ms);
  EXPECT_EQ(revision(), before);
  EXPECT_EQ(counts(), (Counts{0, 0, 0, 2}));
  EXPECT_NE(told_.find("it names a port that does not exist"), std::string::npos) << told_;
}

TEST_F(BadClaimsTest, OnTheModulesOwnRingDockingRefusesTheImpossibleItself) {
  link();
  const std::uint64_t before = revision();
  bus::Participant stranger(on(ring_domain, "stranger"));
  bus::Writer<msg::LinkClaim> claim = stranger.create_writer(topics::link_claim);
  claim.write(changed([](msg::LinkClaim& c) { c.port = 2; }));
  claim.write(changed([](msg::LinkClaim& c) { c.module_id = 3, c.peer_id = 3; }));
  claim.write(changed([](msg::LinkClaim& c) { c.module_id = 4, c.latch = msg::LatchStatus::ready; }));
  run(100ms);
  EXPECT_EQ(revision(), before);
  EXPECT_EQ(rings_->membership.claims_refused(), 3u);
}

}  // namespace
}  // namespace eciton::radio
