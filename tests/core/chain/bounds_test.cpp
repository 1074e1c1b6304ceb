// How long agreeing takes: on a radio without loss, in delays and periods; after a partition, in seconds.
#include <gtest/gtest.h>

#include <iostream>
#include <random>
#include <variant>

#include "tests/core/chain/protocol_world.hpp"

namespace eciton::chain::test {
namespace {

constexpr Duration tick = 1ms, period = 10ms;

/// Modules that look once a period, out of step with each other, and publish on change. All links form at once; each
/// latch reports its own when it likes.
class Assembly {
 public:
  Assembly(std::uint64_t seed, Airframe airframe, Duration delay_max, int periods_kept)
      : random_(seed), delay_max_(delay_max), periods_kept_(periods_kept), airframe_(airframe) {
    const int n = 2 + draw(15);
    for (int k = 0; k < n; ++k) {
      modules_.emplace_back(static_cast<std::uint32_t>(k + 1), ports(), rule());
      modules_.back().phase = draw(period / tick);
    }
    for (Module& m : modules_) {
      for (const Module& other : modules_) {
        if (other.id != m.id) m.peers.push_back({other.id, true, Duration{}});
        for (std::uint32_t port = 0; port < ports(); ++port)
          m.claims.join({.module = other.id, .port = port, .incarnation = 1});
      }
    }
    for (int k = 0; k + 1 < n; ++k) {
      const std::uint32_t id = modules_[k].id;
      const bool up = airframe_ == Airframe::lattice && k % 2 == 1;  // stairs
      const std::uint32_t port = up ? 1 : 0;
      const std::uint32_t peer_port = airframe_ == Airframe::chain ? 1 : LatticeRule::opposite(port);
      expect(k, {id, port, id + 1, peer_port, false, LatchStatus::latched, 1, 1});
      expect(k + 1, {id + 1, peer_port, id, port, false, LatchStatus::latched, 1, 1});
    }
  }

  void run() {
    for (; now_ < 3s && !all_active(); now_ += tick) {
      deliver();
      for (Module& m : modules_) {
        if ((now_ / tick + m.phase) % (period / tick) == 0) step(m);
      }
      if (agreed_ == Duration{} && last_claim_due_ <= now_ && all_claimed() && all_know_the_start()) agreed_ = now_;
    }
  }

  /// From the arrival of the last claim until all members know that all hold the same view, and its start.
  Duration time_to_agree() const { return agreed_ != Duration{} ? agreed_ - last_claim_due_ : Duration{1h}; }
  /// Until all fly it.
  Duration time_to_fly() const { return now_ - last_claim_due_; }

 private:
  struct Module {
    Module(std::uint32_t module, std::uint32_t ports, const StructureRule& rule)
        : id(module), agreement({.module = module, .incarnation = 1, .ports = ports}, rule) {}
    std::uint32_t id;
    Agreement agreement;
    ClaimTable claims;
    AnnouncementTable announcements;
    std::vector<PeerStatus> peers;
    std::vector<std::pair<Duration, Claim>> to_claim;
    std::int64_t phase = 0;
    std::uint64_t published = 0;
    int kept_for = 0;
  };
  struct Message {
    Duration due;
    std::size_t to;
    std::variant<Claim, Announcement> said;
  };

  int draw(std::int64_t n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }
  std::uint32_t ports() const { return airframe_ == Airframe::chain ? 2 : 4; }
  const StructureRule& rule() const {
    if (airframe_ == Airframe::chain) return chain_;
    return lattice_;
  }
  void expect(int module, const Claim& claim) {
    modules_[module].to_claim.emplace_back(500ms + draw(200) * tick, claim);
  }
  void send(const Module& from, const std::variant<Claim, Announcement>& said) {
    for (std::size_t to = 0; to < modules_.size(); ++to) {
      if (modules_[to].id == from.id) continue;
      const Duration due = now_ + (1 + draw(delay_max_ / tick)) * tick;
      in_flight_.push_back({due, to, said});
      if (std::holds_alternative<Claim>(said)) last_claim_due_ = std::max(last_claim_due_, due);
    }
  }
  void deliver() {
    std::erase_if(in_flight_, [&](const Message& message) {
      if (message.due > now_) return false;
      Module& to = modules_[message.to];
      if (const auto* claim = std::get_if<Claim>(&message.said)) to.claims.join(*claim);
      if (const auto* said = std::get_if<Announcement>(&message.said)) to.announcements.join(*said);
      return true;
    });
  }
  void step(Module& m) {
    std::erase_if(m.to_claim, [&](const auto& claim) {
      if (claim.first > now_) return false;
      m.claims.join(claim.second);
      send(m, claim.second);
      return true;
    });
    m.agreement.update(TimePoint{100s + now_}, m.claims, m.announcements, m.peers);
    if (m.agreement.announcement().sequence_number == m.published || m.kept_for++ < periods_kept_) return;
    m.kept_for = 0;
    m.published = m.agreement.announcement().sequence_number;
    send(m, m.agreement.announcement());
  }
  bool all_claimed() const {
    return std::all_of(modules_.begin(), modules_.end(), [](const Module& m) { return m.to_claim.empty(); });
  }
  bool all_know_the_start() const {
    const std::uint64_t epoch = modules_.front().agreement.announcement().epoch;
    return std::all_of(modules_.begin(), modules_.end(), [&](const Module& m) {
      const Announcement& said = m.agreement.announcement();
      return said.epoch != 0 && said.epoch == epoch && said.has_start() &&
             m.agreement.held()->members.size() == modules_.size();
    });
  }
  bool all_active() const {
    return std::all_of(modules_.begin(), modules_.end(), [&](const Module& m) {
      return m.agreement.active() && m.agreement.active()->members.size() == modules_.size();
    });
  }

  std::mt19937_64 random_;
  Duration delay_max_;
  int periods_kept_;  // an announcement is held back for so many periods
  Airframe airframe_;
  ChainRule chain_;
  LatticeRule lattice_;
  std::vector<Module> modules_;
  std::vector<Message> in_flight_;
  Duration now_{}, last_claim_due_{}, agreed_{};
};

/// The longest over many assemblies.
std::pair<Duration, Duration> slowest(Airframe airframe, Duration delay_max, int periods_kept = 0) {
  Duration agree{}, fly{};
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Assembly assembly(seed, airframe, delay_max, periods_kept);
    assembly.run();
    agree = std::max(agree, assembly.time_to_agree());
    fly = std::max(fly, assembly.time_to_fly());
  }
  return {agree, fly};
}

TEST(ChainBoundsTest, AgreesWithinThreeDelaysAndTwoPeriodsOfTheLastClaim) {
  for (const Airframe airframe : {Airframe::chain, Airframe::lattice}) {
    for (const Duration delay_max : {10ms, 20ms, 50ms}) {
      const auto [agree, fly] = slowest(airframe, delay_max);
      std::cout << (airframe == Airframe::chain ? "chain" : "lattice") << ", delay up to " << to_s(delay_max) * 1e3
                << " ms: agreed in " << to_s(agree) * 1e3 << " ms, flown in " << to_s(fly) * 1e3 << " ms\n";
      EXPECT_LE(agree, 3 * delay_max + 2 * period);
      EXPECT_GT(agree, delay_max);  // two crossings at least, or the test does not see what it measures
      // The start lies a margin after the base's decision, which is a crossing and two looks after the last claim.
      EXPECT_LE(fly, std::max(agree, delay_max + 2 * period + AgreementConfig{}.start_margin) + period);
    }
  }
}

TEST(ChainBoundsTest, SeesAnnouncementsThatAreHeldBack) {
  const auto [agree, fly] = slowest(Airframe::chain, 20ms, 3);
  EXPECT_GT(agree, 3 * 20ms + 2 * period);
}

/// All dock while the radio is split in two; then it heals.
Schedule healed(std::uint64_t seed, Airframe airframe, double loss) {
  Schedule schedule = draw_schedule(seed, airframe);
  std::erase_if(schedule.events, [](const Event& event) { return event.kind != EventKind::dock || event.at > 3s; });
  const int mask = static_cast<int>(seed % (1u << schedule.modules));
  schedule.events.insert(schedule.events.begin(), Event{.kind = EventKind::split, .b = mask});
  schedule.events.push_back({.at = 4s, .kind = EventKind::heal});
  schedule.loss = loss;
  return schedule;
}

TEST(ChainBoundsTest, FliesWhatIsLinkedTwoSecondsAfterAPartitionHeals) {
  Duration slowest_heal{};
  int largest = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Schedule schedule = healed(seed, seed % 2 == 0 ? Airframe::chain : Airframe::lattice, 0.6);
    const WorldResult result = World(schedule, {.agreement_bound = 2s}).run();
    ASSERT_FALSE(result.violation) << *result.violation << '\n' << to_text(schedule);
    slowest_heal = std::max(slowest_heal, result.convergence_max);
    largest = std::max(largest, result.largest);
  }
  std::cout << "slowest at 60 % loss: " << to_s(slowest_heal) << " s, largest structure " << largest << '\n';
  EXPECT_GT(slowest_heal, 150ms);  // a margin and a crossing
  EXPECT_GE(largest, 8);
}

TEST(ChainBoundsTest, SeesAPartitionThatHardlyHeals) {
  int late = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    late += World(healed(seed, Airframe::chain, 0.97), {.agreement_bound = 2s}).run().violation.has_value();
  }
  EXPECT_GT(late, 10);
}

}  // namespace
}  // namespace eciton::chain::test
