// What control knows of the other modules: where they are and how their joints stand, whom they are linked and
// whom they dock with, and so which of them this module keeps its distance from.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/time.hpp"
#include "idl/topics.hpp"
#include "services/control/separation.hpp"

namespace eciton::control {

struct Peer {
  std::uint32_t module_id = 0;
  TimePoint heard_at{};  // stamp of `state` on our clock
  msg::ModuleState state;
  msg::JointState joints;
  msg::FlightMode flight_mode = msg::FlightMode::disarmed;
  std::uint64_t chain_epoch = 0;  // of the chain it flies in; 0: alone
  msg::DockingState docking;
  TimePoint docking_at{};  // when it said so
  std::uint32_t docks_with = 0;
  // Closer than the distance by intention: linked, docking, or so since they stood on the ground. It keeps no
  // distance from them until they have parted, ...
  bool together = false;
  TimePoint together_until{};  // ... or for so long after the reason is gone
};

/// Bounded; real-time safe after construction.
class Neighbourhood {
 public:
  explicit Neighbourhood(std::uint32_t own_id) : own_id_(own_id) {}

  void hear(const msg::ModuleState& state, TimePoint at) noexcept;
  void hear(const msg::JointState& joints) noexcept;
  void hear(const msg::ChainView& view) noexcept;
  void hear(const msg::DockingState& docking, TimePoint at) noexcept;
  void hear(const msg::Beacon& beacon) noexcept;
  const Peer* find(std::uint32_t module_id) const noexcept;
  std::span<const Peer> peers() const noexcept { return peers_; }

  /// Peers nearer than that now are where they may be: before a take-off.
  void accept_those_near(const robot::Vector3& p_WM, double distance_m, TimePoint now) noexcept;
  /// Whom this module, which is at `p_WM`, keeps its distance from. Valid until the next call.
  std::span<const Neighbour> keep_clear_of(const robot::Vector3& p_WM, double distance_m, TimePoint now) noexcept;

 private:
  Peer* slot(std::uint32_t module_id) noexcept;
  bool together_by_intention(const Peer& peer) const noexcept;

  std::uint32_t own_id_;
  std::uint64_t own_epoch_ = 0;  // of our own chain
  std::uint32_t own_docks_with_ = 0;
  std::array<Peer, robot::members_max> peers_{};
  std::array<Neighbour, robot::members_max> neighbours_{};
};

}  // namespace eciton::control
