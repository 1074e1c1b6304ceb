// Peers as they are heard.
#include "services/control/control_service_neighbourhood.hpp"

#include <algorithm>

#include "core/robot/arrays.hpp"

namespace eciton::control {
namespace {

constexpr Duration forget_after = std::chrono::seconds(60);  // not heard for so long: gone
constexpr Duration parting_time = std::chrono::seconds(10);  // for a pair that docks no more to get apart
constexpr double parted_m = 0.02;                            // beyond the distance

/// Flown by a control that keeps its own distance.
bool keeps_distance(msg::FlightMode mode) {
  return mode == msg::FlightMode::takeoff || mode == msg::FlightMode::hover || mode == msg::FlightMode::move ||
         mode == msg::FlightMode::land;
}

double level_distance_m(const Peer& peer, const robot::Vector3& p_WM) {
  return (robot::vector(peer.state.p_WM_m) - p_WM).head<2>().norm();
}

}  // namespace

const Peer* Neighbourhood::find(std::uint32_t module_id) const noexcept {
  const auto found =
      std::find_if(peers_.begin(), peers_.end(), [&](const Peer& p) { return p.module_id == module_id; });
  return found != peers_.end() ? &*found : nullptr;
}

Peer* Neighbourhood::slot(std::uint32_t module_id) noexcept {
  if (module_id == own_id_ || module_id == 0) return nullptr;
  Peer* oldest = &peers_[0];
  for (Peer& p : peers_) {
    if (p.module_id == module_id) return &p;
    if (p.module_id == 0 || (oldest->module_id != 0 && p.heard_at < oldest->heard_at)) oldest = &p;
    if (p.module_id == 0) break;  // they fill from the front
  }
  // More in range than a chain can have: whoever was silent longest makes room.
  *oldest = {};
  oldest->module_id = module_id;
  return oldest;
}

void Neighbourhood::hear(const msg::ModuleState& state, TimePoint at) noexcept {
  Peer* p = slot(state.module_id);
  if (p == nullptr || !robot::vector(state.p_WM_m).allFinite() || !robot::vector(state.v_WM_m_s).allFinite()) return;
  p->state = state;
  p->heard_at = at;
}

void Neighbourhood::hear(const msg::JointState& joints) noexcept {
  if (Peer* p = slot(joints.module_id)) p->joints = joints;
}

void Neighbourhood::hear(const msg::ChainView& view) noexcept {
  const std::uint64_t epoch = view.active && view.members.size() > 1 ? view.active_epoch : 0;
  if (view.module_id == own_id_) {
    own_epoch_ = epoch;
  } else if (Peer* p = slot(view.module_id)) {
    p->chain_epoch = epoch;
  }
}

void Neighbourhood::hear(const msg::DockingState& docking, TimePoint at) noexcept {
  const std::uint32_t with = docking.phase != msg::DockingPhase::idle ? docking.peer_id : 0;
  if (docking.module_id == own_id_) {
    own_docks_with_ = with;
  } else if (Peer* p = slot(docking.module_id)) {
    p->docking = docking;
    p->docking_at = at;
    p->docks_with = with;
  }
}

void Neighbourhood::hear(const msg::Beacon& beacon) noexcept {
  if (Peer* p = slot(beacon.module_id)) p->flight_mode = beacon.flight_mode;
}

bool Neighbourhood::together_by_intention(const Peer& peer) const noexcept {
  if (own_epoch_ != 0 && peer.chain_epoch == own_epoch_) return true;
  const auto docks_with_us = [&](const Peer& p) {
    return p.module_id != 0 && (p.module_id == own_docks_with_ || p.docks_with == own_id_);
  };
  if (docks_with_us(peer)) return true;
  // The partner's chain comes with it.
  return peer.chain_epoch != 0 && std::any_of(peers_.begin(), peers_.end(), [&](const Peer& p) {
           return p.chain_epoch == peer.chain_epoch && docks_with_us(p);
         });
}

void Neighbourhood::accept_those_near(const robot::Vector3& p_WM, double distance_m, TimePoint now) noexcept {
  for (Peer& p : peers_) {
    if (p.heard_at == TimePoint{} || level_distance_m(p, p_WM) > distance_m) continue;
    p.together = true;
    p.together_until = now + forget_after;
  }
}

std::span<const Neighbour> Neighbourhood::keep_clear_of(const robot::Vector3& p_WM, double distance_m,
                                                        TimePoint now) noexcept {
  std::size_t count = 0;
  for (Peer& p : peers_) {
    if (p.heard_at == TimePoint{} || now - p.heard_at > forget_after) continue;
    if (together_by_intention(p)) {
      p.together = true;
      p.together_until = now + parting_time;
    } else if (now > p.together_until || level_distance_m(p, p_WM) > distance_m + parted_m) {
      p.together = false;
    }
    if (p.together) continue;
    neighbours_[count++] = {.p_WM = robot::vector(p.state.p_WM_m),
                            .v_WM = robot::vector(p.state.v_WM_m_s),
                            .age_s = to_s(now - p.heard_at),
                            .gives_way = p.chain_epoch == 0 && keeps_distance(p.flight_mode)};
  }
  return std::span(neighbours_).first(count);
}

}  // namespace eciton::control
