// The one bridge between a module's ring and the swarm ring: forwards the topics whose scope is swarm,
// byte for byte, within their rates; introduces its module and sends its beacon; knows every peer's clock.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/config.hpp"
#include "core/bus/participant.hpp"
#include "core/runtime/heartbeat_watch.hpp"
#include "core/runtime/service.hpp"
#include "idl/topics.hpp"
#include "services/radio/airtime.hpp"
#include "services/radio/claim_guard.hpp"
#include "services/radio/duplicate_id.hpp"
#include "services/radio/peer_clock.hpp"

namespace eciton::radio {

struct RadioConfig {
  std::uint32_t module_id = 0;
  std::string name;  // of the module
  std::string airframe;
  std::uint64_t incarnation = 1;
  std::uint32_t ports = 2;  // of each module of the fleet
  double period_s = 0.01;
  double state_rate_Hz = 50;
  double joint_rate_Hz = 50;
  double wrench_rate_Hz = 100;
  double beacon_period_s = 2.0;         // idle
  double beacon_near_period_s = 0.5;    // approaching or in a chain
  double beacon_urgent_period_s = 0.1;  // of the few that follow a change
  double airtime_budget_bit_s = 6e6;    // of the radio's medium, what this module may use
  bool watches = false;  // its module's services, by their heartbeats: where these come by the wall clock

  template <class V>
  void visit_fields(V& v) {
    v("period_s", period_s, in_range(0.001, 0.1));
    v("state_rate_Hz", state_rate_Hz, in_range(1, 500));
    v("joint_rate_Hz", joint_rate_Hz, in_range(1, 500));
    v("wrench_rate_Hz", wrench_rate_Hz, in_range(1, 500));
    v("beacon_period_s", beacon_period_s, in_range(0.1, 10));
    v("beacon_near_period_s", beacon_near_period_s, in_range(0.1, 10));
    v("airtime_budget_bit_s", airtime_budget_bit_s, in_range(1e4, 1e9));
  }
};

class RadioService final : public runtime::Service {
 public:
  RadioService(bus::Participant& ring, bus::Participant& swarm, const RadioConfig& config);
  ~RadioService() override;

  std::string_view name() const override { return "radio"; }
  runtime::Schedule schedule() override {
    return runtime::every(from_s(config_.period_s), runtime::Phase::coordinate);
  }
  void step(TimePoint now) noexcept override;
  void describe(msg::Heartbeat& heartbeat) const noexcept override { heartbeat.rejected = claim_guard_.refused(); }

 private:
  struct Route;
  /// Of a module that was not heard yet.
  struct HeldClaim {
    GuardedClaim claim;
    std::uint64_t origin = 0;
    TimePoint since{};
    bool overdue = false;  // counted as of an unknown module
    std::size_t size = 0;  // 0: a free place
    std::array<std::uint8_t, bus::TypeTraits<msg::LinkClaim>::size_max> bytes{};
  };

  void add_route(const bus::TopicInfo& topic);
  void forward_out(Route& route) noexcept;
  void forward_in(Route& route) noexcept;
  void watch_own_module() noexcept;
  void take_heartbeats() noexcept;
  void hear_beacons(TimePoint now) noexcept;
  void meet_own_id(const msg::Beacon& beacon, TimePoint now) noexcept;
  void send_beacon(TimePoint now) noexcept;
  void add_echoes(std::size_t most, TimePoint now) noexcept;
  void write_state(TimePoint now) noexcept;
  void introduce(TimePoint now) noexcept;
  // radio_service_claims.cpp
  void take_claim(bus::RawWriter& to_ring, std::span<const std::uint8_t> cdr, std::uint64_t origin) noexcept;
  void hold_claim(const GuardedClaim& claim, std::span<const std::uint8_t> cdr, std::uint64_t origin) noexcept;
  void look_at_held_claims() noexcept;
  void refuse_claim(ClaimFault fault, std::uint32_t module) noexcept;
  void add_refused_claims(msg::RadioState& state) const noexcept;

  RadioConfig config_;
  bus::Participant& ring_;
  bus::Participant& swarm_;
  std::vector<Route> routes_;
  TimePoint now_{};
  TimePoint beacon_due_{};
  TimePoint state_due_{};
  int urgent_beacons_ = 0;
  bool near_ = false;  // approaching or in a chain: wrenches go out
  bool docking_ = false;
  bool courted_ = false;  // a peer approaches us
  bool chained_ = false;
  DuplicateId own_id_;
  bool duplicate_id_ = false;
  ClaimGuard claim_guard_;
  std::array<HeldClaim, 16> held_claims_{};
  std::array<std::optional<TimePoint>, claim_fault_count> claims_told_at_{};
  bus::RawReader* claims_from_swarm_ = nullptr;  // of their route
  bus::RawWriter* claims_to_ring_ = nullptr;
  runtime::HeartbeatWatch watch_;
  Airtime airtime_;
  std::uint64_t sent_ = 0;
  std::uint64_t dropped_ = 0;
  msg::Beacon beacon_;
  /// A peer's last beacon, to be echoed.
  struct Heard {
    std::int64_t stamp_ns = 0;  // its clock
    std::optional<TimePoint> received;
  };
  std::array<PeerClock, 128> clocks_;  // by module id
  std::array<Heard, 128> heard_;       // likewise
  std::size_t echoed_ = 0;             // the last one, by turns
  bool introduced_ = false;

  bus::Reader<msg::DockingState> docking_state_;
  bus::Reader<msg::ChainView> chain_view_;
  bus::Reader<msg::ModuleState> module_state_;
  bus::Reader<msg::ExternalWrench> external_wrench_;
  bus::Reader<msg::Heartbeat> heartbeat_;
  bus::Reader<msg::Beacon> beacons_heard_;
  bus::Writer<msg::Beacon> beacon_to_swarm_;
  bus::Writer<msg::Beacon> beacon_to_ring_;
  bus::Writer<msg::RadioState> radio_state_;
  bus::Writer<msg::ModuleInfo> module_info_;
  bus::Writer<msg::Fault> fault_;
};

}  // namespace eciton::radio
