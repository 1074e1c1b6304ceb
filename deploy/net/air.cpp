// Draws first, then airtime, then flight: a frame that nobody hears, or that the medium drops, takes no airtime.
#include "deploy/net/air.hpp"

#include <algorithm>
#include <cmath>

namespace eciton::net {
namespace {

bool later(const Flight& a, const Flight& b) { return a.due != b.due ? a.due > b.due : a.order > b.order; }

}  // namespace

Air::Air(std::vector<std::string> hosts, std::uint64_t seed)
    : hosts_(std::move(hosts)), links_(hosts_.size() * hosts_.size()), group_of_(hosts_.size(), 0) {
  for (std::uint32_t from = 0; from < hosts_.size(); ++from) {
    for (std::uint32_t to = 0; to < hosts_.size(); ++to) {
      at(from, to).random =
          bus::sim_network::RandomStream(bus::sim_network::link_seed(seed, hosts_[from], hosts_[to]));
    }
  }
  hearing_.reserve(hosts_.size());
  flights_.reserve(flights_max);
}

std::optional<std::uint32_t> Air::index_of(const std::string& host) const {
  const auto found = std::find(hosts_.begin(), hosts_.end(), host);
  if (found == hosts_.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - hosts_.begin());
}

void Air::set_link(std::uint32_t from, std::uint32_t to, const LinkSettings& settings) {
  Link& link = at(from, to);
  link.settings = settings;
  if (settings.burst_start <= 0) link.in_burst = false;
}

void Air::partition(const std::vector<std::vector<std::uint32_t>>& groups) {
  groups_ = groups;
  std::fill(group_of_.begin(), group_of_.end(), 0);
  for (std::size_t k = 0; k < groups.size(); ++k) {
    for (const std::uint32_t host : groups[k]) group_of_[host] = static_cast<std::uint32_t>(k + 1);
  }
}

std::uint32_t Air::send(const Frame& frame, Duration now) {
  hearing_.clear();
  if (frame.to) {
    if (*frame.to != frame.from) draw(frame, *frame.to);
  } else {
    for (std::uint32_t to = 0; to < hosts_.size(); ++to) {
      if (to != frame.from) draw(frame, to);
    }
  }
  if (hearing_.empty()) return 0;
  if (frame.slot == Frame::no_slot || !occupy(frame.bytes, now)) {
    for (const Hearing& hearing : hearing_) ++at(frame.from, hearing.to).counters.dropped;
    return 0;
  }
  std::uint32_t launched = 0;
  for (const Hearing& hearing : hearing_) launched += launch(frame, hearing, medium_.rate.bit_s > 0 ? free_at_ : now);
  return launched;
}

void Air::draw(const Frame& frame, std::uint32_t to) {
  Link& link = at(frame.from, to);
  ++link.counters.sent;
  ++link.sequence;
  if (link.settings.cut || group_of_[frame.from] != group_of_[to]) {
    ++link.counters.lost;
    return;
  }
  LinkQuality quality = link.settings.quality;
  if (link.settings.burst_start > 0) {
    link.in_burst =
        link.in_burst ? !link.random.chance(link.settings.burst_end) : link.random.chance(link.settings.burst_start);
    if (link.in_burst) quality.loss = link.settings.burst_loss;
  }
  const bus::sim_network::Fate fate = bus::sim_network::decide(quality, false, link.random);
  if (fate.lost) {
    ++link.counters.lost;
  } else {
    hearing_.push_back({to, fate});
  }
}

/// The medium, from when it is free until the frame has been sent. False: that would be too long to wait.
bool Air::occupy(std::uint32_t bytes, Duration now) {
  if (medium_.rate.bit_s <= 0) return true;
  const Duration start = std::max(now, free_at_);
  if (start - now > medium_.backlog) return false;
  free_at_ = start + Duration{static_cast<Duration::rep>(std::ceil(8e9 * bytes / medium_.rate.bit_s))};
  return true;
}

std::uint32_t Air::launch(const Frame& frame, const Hearing& hearing, Duration sent_at) {
  Link& link = at(frame.from, hearing.to);
  Flight flight{.due = sent_at + hearing.fate.delay,
                .sequence = link.sequence,
                .from = frame.from,
                .to = hearing.to,
                .bytes = frame.bytes,
                .slot = frame.slot};
  if (!hearing.fate.held_back) link.last_due = flight.due = std::max(flight.due, link.last_due);
  const std::uint32_t launched = launch(link, flight);
  if (!hearing.fate.duplicate) return launched;
  ++link.counters.duplicated;
  flight.due = std::max(flight.due, sent_at + *hearing.fate.duplicate);
  flight.duplicate = true;
  return launched + launch(link, flight);
}

std::uint32_t Air::launch(Link& link, Flight flight) {
  if (flights_.size() >= flights_max) {
    ++link.counters.dropped;
    return 0;
  }
  flight.order = ++order_;
  flights_.push_back(flight);
  std::push_heap(flights_.begin(), flights_.end(), later);
  return 1;
}

std::optional<Duration> Air::next_due() const {
  if (flights_.empty()) return std::nullopt;
  return flights_.front().due;
}

std::optional<Flight> Air::land(Duration now) {
  if (flights_.empty() || flights_.front().due > now) return std::nullopt;
  std::pop_heap(flights_.begin(), flights_.end(), later);
  const Flight flight = flights_.back();
  flights_.pop_back();
  Link& link = at(flight.from, flight.to);
  ++link.counters.delivered;
  link.counters.bytes += flight.bytes;
  if (flight.sequence < link.landed && !flight.duplicate) ++link.counters.reordered;
  link.landed = std::max(link.landed, flight.sequence);
  return flight;
}

void Air::refuse(const Flight& flight) {
  LinkCounters& counters = at(flight.from, flight.to).counters;
  --counters.delivered;
  counters.bytes -= flight.bytes;
  ++counters.dropped;
}

}  // namespace eciton::net
