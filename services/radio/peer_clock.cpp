// Offsets out of echoes.
#include "services/radio/peer_clock.hpp"

#include <algorithm>

namespace eciton::radio {

void PeerClock::hear(TimePoint now, TimePoint) { last_heard_ = now; }

void PeerClock::echo(TimePoint now, TimePoint peer_sent, TimePoint our_stamp, TimePoint peer_received) {
  const Duration round_trip = (now - our_stamp) - (peer_sent - peer_received);
  if (round_trip < Duration{} || round_trip > config_.round_trip_max || peer_sent < peer_received) {
    ++rejected_;
    return;
  }
  const Measurement m{now, ((peer_received - our_stamp) + (peer_sent - now)) / 2, round_trip / 2};
  // An echo may be of an old stamp, if ours were lost since: the clocks drifted meanwhile.
  const Duration drifted = std::chrono::round<Duration>(config_.drift * (now - our_stamp));
  const Measurement widened{m.at, m.offset, m.half_round_trip + drifted};
  const Measurement* const known = best(now);
  if (known != nullptr &&
      std::chrono::abs(widened.offset - known->offset) > widened.half_round_trip + bound_of(*known, now)) {
    measurements_.fill(std::nullopt);
    ++steps_;
  }
  keep(widened);
}

void PeerClock::keep(const Measurement& m) {
  const Duration begun = m.at - slot_begin_;
  if (begun >= config_.window / static_cast<int>(slots) || begun < Duration{}) {
    slot_ = (slot_ + 1) % slots;
    slot_begin_ = m.at;
    measurements_[slot_].reset();
  }
  auto& place = measurements_[slot_];
  if (!place || m.half_round_trip <= bound_of(*place, m.at)) place = m;
}

Duration PeerClock::bound_of(const Measurement& m, TimePoint now) const {
  return m.half_round_trip + std::chrono::round<Duration>(config_.drift * std::chrono::abs(now - m.at));
}

const PeerClock::Measurement* PeerClock::best(TimePoint now) const {
  const Measurement* found = nullptr;
  for (const auto& m : measurements_) {
    if (!m || std::chrono::abs(now - m->at) > config_.window) continue;
    if (found == nullptr || bound_of(*m, now) < bound_of(*found, now)) found = &*m;
  }
  return found;
}

std::optional<ClockOffset> PeerClock::offset(TimePoint now) const {
  const Measurement* const m = best(now);
  if (m == nullptr) return std::nullopt;
  return ClockOffset{m->offset, bound_of(*m, now)};
}

std::optional<Duration> PeerClock::age(TimePoint now, TimePoint peer_stamp) const {
  const auto known = offset(now);
  if (!known) return std::nullopt;
  return std::max(now - (peer_stamp - known->offset), Duration{});
}

}  // namespace eciton::radio
