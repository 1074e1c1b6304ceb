// Samples to knowledge, and poses of any module's ports.
#include "services/docking/docking_service_heard.hpp"

#include <algorithm>

#include "core/chain/freshness.hpp"
#include "core/robot/arrays.hpp"

namespace eciton::docking {
namespace {

constexpr chain::FreshnessConfig freshness;
constexpr double ahead_s_max = 0.2;

bool in_the_air(msg::FlightMode mode) { return mode == msg::FlightMode::hover || mode == msg::FlightMode::move; }

}  // namespace

HeardModules::HeardModules(bus::Participant& ring, std::uint32_t own_id, const robot::Airframe& airframe)
    : own_id_(own_id),
      airframe_(airframe),
      module_states_(ring.create_reader(topics::module_state)),
      joint_states_(ring.create_reader(topics::joint_state)),
      external_wrenches_(ring.create_reader(topics::external_wrench)),
      docking_states_(ring.create_reader(topics::docking_state)),
      beacons_(ring.create_reader(topics::beacon)),
      heartbeats_(ring.create_reader(topics::heartbeat)) {
  modules_[0].id = own_id;
}

const HeardModule* HeardModules::find(std::uint32_t id) const noexcept {
  const auto found =
      std::find_if(modules_.begin(), modules_.end(), [id](const HeardModule& m) { return m.id == id && id != 0; });
  return found == modules_.end() ? nullptr : &*found;
}

HeardModule* HeardModules::note(std::uint32_t id, TimePoint at) noexcept {
  const auto found =
      std::find_if(modules_.begin(), modules_.end(), [id](const HeardModule& m) { return m.id == id || m.id == 0; });
  if (found == modules_.end()) return nullptr;  // more modules in range than we keep: nobody we dock with
  found->id = id;
  found->heard = std::max(found->heard, at);
  return &*found;
}

bool HeardModules::is_fresh(const HeardModule& module, bool near, TimePoint now) const {
  return module.heard != TimePoint{} && chain::is_fresh(now - module.heard, near, freshness);
}

void HeardModules::take(TimePoint now) noexcept {
  take_states(now);
  take_conditions(now);
}

void HeardModules::take_states(TimePoint now) noexcept {
  while (const auto s = module_states_.take()) {
    HeardModule* m = note(s->value.module_id, now - s->age);
    if (m == nullptr) continue;
    m->state = s->value;
    m->state_at = now - s->age;
  }
  while (const auto s = joint_states_.take()) {
    HeardModule* m = note(s->value.module_id, now - s->age);
    for (std::size_t k = 0; m != nullptr && k < std::min(s->value.joints.size(), airframe_.joints.size()); ++k) {
      m->joint_rad[k] = s->value.joints[k].position_rad;
    }
  }
  while (const auto s = external_wrenches_.take()) {
    HeardModule* m = note(s->value.module_id, now - s->age);
    if (m == nullptr) continue;
    m->zeroed = s->value.zeroed;
    m->external_force_W = robot::vector(s->value.force_W_N);
  }
}

void HeardModules::take_conditions(TimePoint now) noexcept {
  while (const auto s = docking_states_.take()) {
    if (s->value.module_id == own_id_) continue;
    if (HeardModule* m = note(s->value.module_id, now - s->age)) m->docking = s->value;
  }
  while (const auto s = beacons_.take()) {
    if (s->value.module_id == own_id_) continue;
    HeardModule* m = note(s->value.module_id, now);
    if (m == nullptr) continue;
    m->flying = in_the_air(s->value.flight_mode);
    m->zeroed = m->zeroed || s->value.wrench_zeroed;
  }
  radio_beat_.reset();
  while (const auto s = heartbeats_.take()) {
    if (s->value.module_id != own_id_) continue;
    if (s->value.service == "control") modules_[0].flying = in_the_air(s->value.flight_mode);
    if (s->value.service == "radio") radio_beat_ = s->value;
  }
}

std::span<const double> HeardModules::joints_of(const HeardModule& module) const {
  return std::span<const double>(module.joint_rad).first(airframe_.joints.size());
}

robot::Pose HeardModules::centre_pose_W(const HeardModule& module, TimePoint now) const {
  // States cross the radio in tens of milliseconds.
  const double ahead_s = std::clamp(to_s(now - module.state_at), 0.0, ahead_s_max);
  const robot::Vector3 w = robot::vector(module.state.w_WM_M_rad_s);
  return {robot::vector(module.state.p_WM_m) + robot::vector(module.state.v_WM_m_s) * ahead_s,
          robot::rotation(module.state.q_WM) * robot::exp_so3(w * ahead_s)};
}

robot::Pose HeardModules::body_pose_W(const HeardModule& module, TimePoint now) const {
  const robot::Pose X_WM = centre_pose_W(module, now);
  return {X_WM.p - X_WM.R * robot::com_offset_B(airframe_, joints_of(module)), X_WM.R};
}

robot::Pose HeardModules::port_pose_W(const HeardModule& module, std::uint32_t port, TimePoint now) const {
  return body_pose_W(module, now) * robot::port_pose_B(airframe_, static_cast<int>(port), joints_of(module));
}

robot::Pose HeardModules::centre_from_port(const HeardModule& module, std::uint32_t port) const {
  const robot::Pose X_BM{robot::com_offset_B(airframe_, joints_of(module)), robot::Matrix3::Identity()};
  return robot::port_pose_B(airframe_, static_cast<int>(port), joints_of(module)).inverse() * X_BM;
}

}  // namespace eciton::docking
