// take from one ring; forward to the other; beacon.
#include "services/radio/radio_service.hpp"

#include <algorithm>
#include <cstring>

#include "services/radio/rate_limit.hpp"

namespace eciton::radio {
namespace {

/// The module id is the first key of every swarm topic; the key hash is big-endian.
std::uint32_t module_of(const bus::TopicInfo& topic, std::span<const std::uint8_t> cdr) {
  std::uint8_t hash[16] = {};
  topic.type.key_hash(cdr.data(), static_cast<std::uint32_t>(cdr.size()), 0, hash);
  return static_cast<std::uint32_t>(hash[0]) << 24 | static_cast<std::uint32_t>(hash[1]) << 16 |
         static_cast<std::uint32_t>(hash[2]) << 8 | hash[3];
}

constexpr Duration echo_age_max = std::chrono::seconds(20);        // of a peer that is still there
constexpr Duration state_period = std::chrono::milliseconds(250);  // `eciton status` listens for half a second
constexpr std::uint32_t rtps_overhead_bytes = 98;  // Ethernet 14, IP 20, UDP 8, RTPS 20, time stamp 12, data 24

enum class Crosses { always, near, chained };  // outward: at any time, near a peer, in a chain

}  // namespace

/// One topic's way across. Outward: this module's own samples, within the rate. Inward: the peers' samples,
/// and goals whoever they are for, since a goal to a member of a chain is for all of it.
struct RadioService::Route {
  bus::RawReader from_ring;
  bus::RawWriter to_swarm;
  bus::RawReader from_swarm;
  bus::RawWriter to_ring;
  RateLimit limit;
  bool goal;
  bool claims;
  Crosses crosses;
  RadioService* radio = nullptr;
};

RadioService::RadioService(bus::Participant& ring, bus::Participant& swarm, const RadioConfig& config)
    : config_(config),
      ring_(ring),
      swarm_(swarm),
      claim_guard_({.own_id = config.module_id, .ports = config.ports}),
      watch_(config.module_id, "radio", from_s(config.period_s)),
      airtime_({.budget_bit_s = config.airtime_budget_bit_s, .overhead_bytes = rtps_overhead_bytes}),
      docking_state_(ring.create_reader(topics::docking_state)),
      chain_view_(ring.create_reader(topics::chain_view)),
      module_state_(ring.create_reader(topics::module_state)),
      external_wrench_(ring.create_reader(topics::external_wrench)),
      heartbeat_(ring.create_reader(topics::heartbeat)),
      beacons_heard_(swarm.create_reader(topics::beacon)),
      beacon_to_swarm_(swarm.create_writer(topics::beacon)),
      beacon_to_ring_(ring.create_writer(topics::beacon)),
      radio_state_(ring.create_writer(topics::radio_state)),
      module_info_(ring.create_writer(topics::module_info)),
      fault_(ring.create_writer(topics::fault)) {
  routes_.reserve(std::tuple_size_v<decltype(topics::all)>);
  topics::for_each([this](const auto& topic) {
    using T = typename std::decay_t<decltype(topic)>::Type;
    // The beacon is the radio's own; everything else that is for the swarm crosses untouched.
    if (topic.scope != bus::Scope::swarm || std::is_same_v<T, msg::Beacon>) return;
    add_route(bus::info(topic));
  });
  // The routes stay where they are from here on.
  for (Route& route : routes_) {
    if (!route.claims) continue;
    claims_from_swarm_ = &route.from_swarm;
    claims_to_ring_ = &route.to_ring;
  }
  beacons_heard_.tell_origins();
  beacon_.module_id = config.module_id;
  beacon_.incarnation = config.incarnation;
}

RadioService::~RadioService() = default;

void RadioService::add_route(const bus::TopicInfo& topic) {
  const auto interval = [](double rate_Hz) { return from_s(1 / rate_Hz); };
  const bool wrench = topic.name == topics::external_wrench.name;
  const bool joints = topic.name == topics::joint_state.name;
  // A docking module's own reference is for its own control; those of a chain are for all members.
  const bool docking = topic.name == topics::docking_reference.name;
  const bool chained = docking || topic.name == topics::base_reference.name;
  Duration pace{};
  if (wrench) pace = interval(config_.wrench_rate_Hz);
  if (joints) pace = interval(config_.joint_rate_Hz);
  if (topic.name == topics::module_state.name || docking) pace = interval(config_.state_rate_Hz);
  const bool goal = topic.qos == bus::QosClass::command;
  routes_.push_back({.from_ring = ring_.create_raw_reader(topic),
                     .to_swarm = swarm_.create_raw_writer(topic),
                     .from_swarm = swarm_.create_raw_reader(topic),
                     .to_ring = ring_.create_raw_writer(topic),
                     .limit = RateLimit(pace),
                     .goal = goal,
                     .claims = topic.name == topics::link_claim.name,
                     .crosses = chained            ? Crosses::chained
                                : wrench || joints ? Crosses::near
                                                   : Crosses::always,
                     .radio = this});
}

void RadioService::step(TimePoint now) noexcept {
  now_ = now;
  introduce(now);
  watch_own_module();
  hear_beacons(now);
  for (Route& route : routes_) {
    forward_out(route);
    forward_in(route);
  }
  look_at_held_claims();
  // Further ahead than any period: the clock was set back.
  const Duration longest = from_s(std::max(config_.beacon_period_s, config_.beacon_near_period_s));
  if (now >= beacon_due_ || beacon_due_ > now + longest) send_beacon(now);
  if (now >= state_due_ || state_due_ > now + longest) write_state(now);
}

void RadioService::forward_out(Route& route) noexcept {
  route.from_ring.take(
      [](void* context, std::span<const std::uint8_t> cdr) {
        auto& r = *static_cast<Route*>(context);
        RadioService& radio = *r.radio;
        const std::uint32_t module = module_of(r.from_ring.topic(), cdr);
        if (r.goal || module != radio.config_.module_id) return;
        if (r.crosses == Crosses::near && !radio.near_) return;
        if (r.crosses == Crosses::chained && !radio.chained_) return;
        if (!r.limit.allow(radio.now_, module)) return;
        ++(r.to_swarm.write(cdr) ? radio.sent_ : radio.dropped_);
        radio.airtime_.add(radio.now_, cdr.size());
      },
      &route);
}

void RadioService::forward_in(Route& route) noexcept {
  route.from_swarm.take(
      [](void* context, std::span<const std::uint8_t> cdr) {
        auto& r = *static_cast<Route*>(context);
        if (r.claims) return r.radio->take_claim(r.to_ring, cdr, r.from_swarm.origin());
        if (!r.goal && module_of(r.from_swarm.topic(), cdr) == r.radio->config_.module_id) return;
        r.to_ring.write(cdr);
      },
      &route);
}

void RadioService::watch_own_module() noexcept {
  while (const auto state = docking_state_.take()) {
    const bool own = state->value.module_id == config_.module_id;
    const bool names_us =
        state->value.peer_id == config_.module_id && state->value.role == msg::DockingRole::follower;
    if (own) docking_ = state->value.phase != msg::DockingPhase::idle;
    // A follower that approaches us hears our wrench before our own docking service has noticed it.
    if (names_us) courted_ = state->value.phase != msg::DockingPhase::idle;
  }
  while (const auto view = chain_view_.take()) {
    if (view->value.module_id == config_.module_id)
      chained_ = view->value.members.size() > 1 || view->value.epoch != 0;
  }
  const msg::Beacon before = beacon_;
  while (const auto state = module_state_.take()) {
    if (state->value.module_id == config_.module_id) beacon_.estimator_mode = state->value.mode;
  }
  while (const auto wrench = external_wrench_.take()) {
    if (wrench->value.module_id == config_.module_id) beacon_.wrench_zeroed = wrench->value.zeroed;
  }
  take_heartbeats();
  const bool was_near = near_;
  near_ = docking_ || courted_ || chained_;
  // What peers decide by is told at once, not at the next beacon, and more than once: beacons may be lost.
  const bool changed = beacon_.wrench_zeroed != before.wrench_zeroed || beacon_.flight_mode != before.flight_mode ||
                       beacon_.estimator_mode != before.estimator_mode || near_ != was_near;
  if (!changed) return;
  beacon_due_ = std::min(beacon_due_, now_);
  urgent_beacons_ = 4;
}

void RadioService::take_heartbeats() noexcept {
  watch_.begin(now_);
  while (const auto beat = heartbeat_.take()) {
    const msg::Heartbeat& b = beat->value;
    if (b.module_id == config_.module_id && b.service == "control") beacon_.flight_mode = b.flight_mode;
    if (config_.watches) watch_.hear(b);
  }
  watch_.tell(fault_);
}

void RadioService::hear_beacons(TimePoint now) noexcept {
  bool clocks_learned = false;
  while (const auto heard = beacons_heard_.take()) {
    const msg::Beacon& beacon = heard->value;
    if (beacon.module_id == config_.module_id) {
      meet_own_id(beacon, now);
      continue;
    }
    claim_guard_.hear_beacon(beacon.module_id, beacon.incarnation, heard->origin);
    beacon_to_ring_.write(beacon);
    if (beacon.module_id >= clocks_.size()) continue;
    heard_[beacon.module_id] = {beacon.stamp_ns, now};
    PeerClock& clock = clocks_[beacon.module_id];
    clock.hear(now, from_ns(beacon.stamp_ns));
    for (const msg::PeerEcho& echo : beacon.peers) {
      if (echo.module_id != config_.module_id) continue;
      clock.echo(now, from_ns(beacon.stamp_ns), from_ns(echo.stamp_ns), from_ns(echo.received_ns));
      clocks_learned = true;
    }
  }
  if (clocks_learned) write_state(now);
}

void RadioService::meet_own_id(const msg::Beacon& beacon, TimePoint now) noexcept {
  own_id_.hear(now, beacon.incarnation, from_ns(beacon.stamp_ns));
  if (!duplicate_id_ && beacon.incarnation != config_.incarnation) {
    // Ourselves before a restart, or another with our id: whether they take turns shows sooner when they come sooner.
    beacon_due_ = std::min(beacon_due_, now);
    urgent_beacons_ = 4;
  }
  if (duplicate_id_ || !own_id_.met(now)) return;
  duplicate_id_ = true;
  beacon_due_ = now;
  msg::Fault out{.module_id = config_.module_id, .stamp_ns = to_ns(now), .severity = msg::Severity::error};
  out.service = "radio";
  out.device = "swarm ring";
  out.text = "another module with our id is heard: give one of them another id; we refuse to arm";
  fault_.write(out);
}

void RadioService::introduce(TimePoint now) noexcept {
  if (introduced_) return;
  introduced_ = true;
  msg::ModuleInfo info{.module_id = config_.module_id,
                       .stamp_ns = to_ns(now),
                       .incarnation = config_.incarnation,
                       .name = {},
                       .airframe = {}};
  info.name.assign(config_.name);
  info.airframe.assign(config_.airframe);
  module_info_.write(info);
}

void RadioService::send_beacon(TimePoint now) noexcept {
  const bool idle = !near_ && urgent_beacons_ == 0;
  beacon_.stamp_ns = to_ns(now);
  beacon_.duplicate_id = duplicate_id_;
  add_echoes(idle ? 1 : beacon_.peers.bound(), now);
  own_id_.hear(now, config_.incarnation, now);
  ++(beacon_to_swarm_.write(beacon_) ? sent_ : dropped_);
  beacon_to_ring_.write(beacon_);
  write_state(now);
  beacon_due_ = now + from_s(near_ ? config_.beacon_near_period_s : config_.beacon_period_s);
  if (urgent_beacons_ > 0 && --urgent_beacons_ > 0) beacon_due_ = now + from_s(config_.beacon_urgent_period_s);
}

void RadioService::add_echoes(std::size_t most, TimePoint now) noexcept {
  beacon_.peers.clear();
  for (std::size_t k = 0; k < heard_.size() && beacon_.peers.size() < most; ++k) {
    echoed_ = (echoed_ + 1) % heard_.size();
    const Heard& heard = heard_[echoed_];
    if (!heard.received || std::chrono::abs(now - *heard.received) > echo_age_max) continue;
    beacon_.peers.push_back({.module_id = static_cast<std::uint32_t>(echoed_),
                             .stamp_ns = heard.stamp_ns,
                             .received_ns = to_ns(*heard.received)});
  }
}

void RadioService::write_state(TimePoint now) noexcept {
  msg::RadioState state{.module_id = config_.module_id,
                        .stamp_ns = to_ns(now),
                        .airtime = airtime_.share(now),
                        .sent = sent_,
                        .dropped = dropped_,
                        .peers = {}};
  add_refused_claims(state);
  state_due_ = now + state_period;
  for (std::uint32_t id = 0; id < clocks_.size(); ++id) {
    const auto offset = clocks_[id].offset(now);
    if (!offset) continue;
    state.peers.push_back(
        {.module_id = id, .offset_ns = offset->offset.count(), .offset_bound_ns = offset->bound.count()});
  }
  radio_state_.write(state);
}

}  // namespace eciton::radio
