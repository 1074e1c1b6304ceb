// The part of the docking service that keeps the chain, without the flight that leads there: the same Membership,
// told of its peers by the same topics, at the same rate. Which port nears whose it is told.
#pragma once

#include <array>
#include <mutex>
#include <optional>

#include "benchmarks/formation/member_link.hpp"
#include "core/runtime/service.hpp"
#include "services/docking/docking_service.hpp"

namespace eciton::bench {

class MembershipWork final : public runtime::Service {
 public:
  MembershipWork(bus::Participant& ring, const docking::DockingServiceConfig& config, std::uint32_t ports);

  std::string_view name() const override { return "docking"; }
  runtime::Schedule schedule() override {
    return runtime::every(from_s(1 / config_.rate_Hz), runtime::Phase::coordinate);
  }
  void step(TimePoint now) noexcept override;

  /// From another thread: approach and release take effect with the next step.
  void order(const MemberOrder& order);

 private:
  struct Peer {
    std::uint32_t id = 0;
    TimePoint heard{};
  };

  void take(TimePoint now) noexcept;
  void hear(std::uint32_t id, TimePoint at) noexcept;
  Peer* find(std::uint32_t id) noexcept;
  void follow_orders() noexcept;
  bool near() const;
  void update_membership(TimePoint now) noexcept;
  void write_state(TimePoint now) noexcept;

  docking::DockingServiceConfig config_;
  bus::Participant& ring_;
  docking::Membership membership_;
  std::array<Peer, 33> peers_{};
  std::mutex orders_mutex_;
  std::optional<MemberOrder> pending_;
  std::optional<MemberOrder> docking_;  // under way
  msg::DockingState state_;
  TimePoint state_due_{};
  bool first_step_ = true;

  bus::Reader<msg::ModuleState> module_states_;
  bus::Reader<msg::ExternalWrench> external_wrenches_;
  bus::Reader<msg::DockingState> docking_states_;
  bus::Reader<msg::Beacon> beacons_;
  bus::Writer<msg::DockingState> docking_state_;
};

}  // namespace eciton::bench
