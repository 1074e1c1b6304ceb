// How a sample travels: into the history, through each match's link, and into the readers' queues. The
// functions of the step path (write, take, advance) allocate nothing.
#include <algorithm>
#include <chrono>

#include "core/bus/vendors/sim_network/medium.hpp"

namespace eciton::bus::sim_network {

namespace {

using Steady = std::chrono::steady_clock;
static_assert(std::is_same_v<Steady::duration, Duration>);

}  // namespace

std::int64_t Medium::now_ns() const {
  return pacing_ == Pacing::virtual_time ? virtual_now_ns_ : Steady::now().time_since_epoch().count();
}

bool Medium::write(Writer& writer, std::span<const std::uint8_t> cdr) {
  KeyHash key{};
  // Plain CDR of either byte order; the other vendors' plugins let pass the same.
  const bool well_formed =
      cdr.size() >= 4 && cdr.size() <= writer.type.size_max && cdr[0] == 0 && cdr[1] <= 1 &&
      (writer.type.key_size == 0 ||
       writer.type.key_hash(cdr.data(), static_cast<std::uint32_t>(cdr.size()), 0, key.data()) != 0);
  std::unique_lock lock(mutex_);
  Outgoing outgoing{.writer = writer, .cdr = cdr, .key = key, .sequence = writer.sequence + 1};
  if (!well_formed || (writer.history && !remember(outgoing))) {
    ++writes_refused_;
    return false;
  }
  ++writer.sequence;
  for (const auto& match : writer.matches) send(*match, outgoing);
  if (outgoing.slot != SamplePool::none) writer.pool.release(outgoing.slot);
  deliver_inline(lock);
  return true;
}

/// Into the writer's history, which keeps the last of each key. False: more keys than its bound, or no slot.
bool Medium::remember(Outgoing& outgoing) {
  Writer& writer = outgoing.writer;
  const std::uint32_t slot = writer.pool.acquire(outgoing.cdr, outgoing.key, outgoing.sequence);
  if (slot == SamplePool::none) return false;
  const auto [kept, evicted] = writer.history->insert(outgoing.key, slot);
  if (!kept) {
    writer.pool.release(slot);
    return false;
  }
  if (evicted != SamplePool::none) {
    writer.pool[evicted].evicted_ns = now_ns();
    writer.pool.release(evicted);
  }
  writer.pool.retain(slot);
  outgoing.slot = slot;
  return true;
}

/// What the match's reader has not been sent: to a late joiner, or after a partition.
void Medium::send_history(Match& match) {
  Writer& writer = *match.writer;
  if (!writer.history) return;
  writer.history->for_each([&](std::uint32_t slot) {
    const auto& sample = writer.pool[slot];
    if (sample.sequence < match.next_sequence) return;
    Outgoing outgoing{writer, writer.pool.bytes(slot), sample.key, sample.sequence, slot};
    send(match, outgoing);
  });
}

void Medium::send(Match& match, Outgoing& outgoing) {
  Statistics& count = match.link->statistics;
  if (match.cut && match.reliable) return;  // waits in the history
  ++count.sent;
  if (match.cut) {
    match.count_lost();
    return;
  }
  match.next_sequence = outgoing.sequence + 1;
  const Fate fate = decide(quality_of(*match.link), match.reliable, match.link->random);
  count.retransmitted += fate.attempts - 1;
  if (fate.lost) {
    match.count_lost();
    return;
  }
  const std::int64_t now = now_ns();
  Flight flight{.due_ns = now + fate.delay.count(),
                .order = 0,
                .match = &match,
                .attempt_ns = now + fate.last_attempt.count(),
                .slot = SamplePool::none,
                .ordered = !fate.held_back,
                .duplicate = false};
  if (flight.ordered) {
    if (match.ordered_in_flight > 0) flight.due_ns = std::max(flight.due_ns, match.last_due_ns);
    match.last_due_ns = flight.due_ns;
  }
  launch(outgoing, flight);
  if (!fate.duplicate) return;
  ++count.duplicated;
  if (match.reliable) return;
  flight.due_ns = std::max(flight.due_ns, now + fate.duplicate->count());
  flight.ordered = false;
  flight.duplicate = true;
  launch(outgoing, flight);
}

/// At once where nothing delays it, else into the heap.
void Medium::launch(Outgoing& outgoing, Flight flight) {
  Match& match = *flight.match;
  if (match.ordered_in_flight == 0 && flight.due_ns <= now_ns()) {
    deliver(match, outgoing, flight.duplicate);
    return;
  }
  SamplePool& pool = match.writer->pool;
  if (flights_.size() < flights_max_ && outgoing.slot == SamplePool::none)
    outgoing.slot = pool.acquire(outgoing.cdr, outgoing.key, outgoing.sequence);
  if (flights_.size() >= flights_max_ || outgoing.slot == SamplePool::none) {
    ++match.link->statistics.dropped;
    ++match.reader->losses.rejected;
    return;
  }
  pool.retain(outgoing.slot);
  flight.slot = outgoing.slot;
  flight.order = ++order_;
  if (flight.ordered) ++match.ordered_in_flight;
  flights_.push_back(flight);
  std::push_heap(flights_.begin(), flights_.end(), later);
  if (pacing_ == Pacing::immediate_wall && flights_.front().order == flight.order) sooner_.notify_one();
}

void Medium::land(const Flight& flight) {
  Match& match = *flight.match;
  Writer& writer = *match.writer;
  if (flight.ordered) --match.ordered_in_flight;
  const auto& sample = writer.pool[flight.slot];
  if (match.reliable && flight.attempt_ns > sample.evicted_ns) {
    ++match.link->statistics.superseded;
    ++match.reader->losses.replaced;
  } else {
    deliver(match, {writer, writer.pool.bytes(flight.slot), sample.key, sample.sequence, flight.slot},
            flight.duplicate);
  }
  writer.pool.release(flight.slot);
}

void Medium::land_all_due(std::int64_t now, std::unique_lock<std::mutex>& lock) {
  while (!flights_.empty() && flights_.front().due_ns <= now) {
    std::pop_heap(flights_.begin(), flights_.end(), later);
    const Flight flight = flights_.back();
    flights_.pop_back();
    virtual_now_ns_ = std::max(virtual_now_ns_, flight.due_ns);
    land(flight);
    deliver_inline(lock);
  }
}

void Medium::deliver(Match& match, const Outgoing& sample, bool duplicate) {
  Statistics& count = match.link->statistics;
  Reader& reader = *match.reader;
  const bool late = sample.sequence < match.last_delivered;
  if (late && !duplicate) ++count.reordered;
  if (late && reader.queue.full(sample.key)) {  // it must not push out a later one
    ++count.replaced;
    ++reader.losses.replaced;
    return;
  }
  match.last_delivered = std::max(match.last_delivered, sample.sequence);
  const std::uint32_t slot = reader.pool.acquire(sample.cdr, sample.key, sample.sequence);
  if (slot == SamplePool::none) {
    ++count.dropped;
    ++reader.losses.rejected;
    return;
  }
  reader.pool[slot].origin = match.writer->participant.number;
  const auto [kept, evicted] = reader.queue.insert(sample.key, slot);
  if (!kept) {
    reader.pool.release(slot);
    ++count.dropped;
    ++reader.losses.rejected;
    return;
  }
  if (evicted != SamplePool::none) {
    reader.pool.release(evicted);
    ++count.replaced;
    ++reader.losses.replaced;
  }
  ++count.delivered;
  if (reader.delivery.sample) {
    if (!reader.awaits_delivery) awaiting_.push_back(&reader);
    reader.awaits_delivery = true;
  } else if (reader.delivery.signal) {
    reader.delivery.signal(reader.delivery.context);
  }
}

/// Gives what came to the readers that want it at once. Unlocked, since they may write: what these writes deliver is
/// given by the same loop, not by a call within the call.
void Medium::deliver_inline(std::unique_lock<std::mutex>& lock) {
  if (served_ != nullptr) return;  // the one who serves looks again
  while (!awaiting_.empty()) {
    served_ = awaiting_.back();
    awaiting_.pop_back();
    served_->awaits_delivery = false;
    const eciton_delivery delivery = served_->delivery;
    lock.unlock();
    take(*served_, std::numeric_limits<std::uint32_t>::max(), delivery.sample, delivery.context);
    lock.lock();
    served_ = nullptr;
    served_changed_.notify_all();
  }
}

std::uint32_t Medium::take(Reader& reader, std::uint32_t count_max, eciton_sink sink, void* context) {
  std::uint32_t taken = 0;
  std::unique_lock lock(mutex_);
  for (; taken < count_max && !reader.queue.empty(); ++taken) {
    const std::uint32_t slot = reader.queue.pop();
    const auto bytes = reader.pool.bytes(slot);
    reader.origin = reader.pool[slot].origin;
    lock.unlock();  // the sink may write to another network, which may be writing to this one
    sink(context, bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    lock.lock();
    reader.pool.release(slot);
  }
  return taken;
}

void Medium::advance(TimePoint now) {
  std::unique_lock lock(mutex_);
  if (pacing_ != Pacing::virtual_time) return;
  land_all_due(to_ns(now), lock);
  virtual_now_ns_ = std::max(virtual_now_ns_, to_ns(now));
}

std::optional<TimePoint> Medium::next_delivery() const {
  const std::scoped_lock lock(mutex_);
  if (flights_.empty()) return std::nullopt;
  return from_ns(flights_.front().due_ns);
}

void Medium::run_thread() {
  std::unique_lock lock(mutex_);
  while (!ending_) {
    if (flights_.empty() || pacing_ != Pacing::immediate_wall) {
      sooner_.wait(lock);
    } else if (const Steady::time_point due{Duration{flights_.front().due_ns}}; due > Steady::now()) {
      sooner_.wait_until(lock, due);
    } else {
      land_all_due(now_ns(), lock);
    }
  }
}

}  // namespace eciton::bus::sim_network
