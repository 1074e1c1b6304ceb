// One thread: sleeps on the participant's waker and the stop flag, takes what came.
#include "deploy/command/listener.hpp"

#include <poll.h>

#include <algorithm>
#include <cstdio>

#include "core/base/wall_clock.hpp"

namespace eciton::deploy {
namespace {

std::vector<TopicEntry const*> distinct(std::vector<const TopicEntry*> topics) {
  std::sort(topics.begin(), topics.end());
  topics.erase(std::unique(topics.begin(), topics.end()), topics.end());
  return topics;
}

}  // namespace

Listener::Listener(const RingOptions& ring, const std::string& tool, const std::vector<const TopicEntry*>& topics,
                   std::uint32_t depth)
    : participant_(participant_config(ring, tool)) {
  ring_ = describe(ring, participant_.config());
  for (const TopicEntry* topic : distinct(topics)) {
    bus::TopicInfo info = topic->info;
    info.depth = depth;
    ears_.push_back({topic, participant_.create_raw_reader(info)});
  }
}

const Listener::Ear& Listener::ear_of(const TopicEntry& topic) const {
  return *std::find_if(ears_.begin(), ears_.end(), [&](const Ear& ear) { return ear.topic == &topic; });
}

std::uint32_t Listener::writers(const TopicEntry& topic) const { return ear_of(topic).reader.matched(); }

const bus::ReaderStatistics& Listener::statistics(const TopicEntry& topic) const {
  return ear_of(topic).reader.statistics();
}

bool Listener::take_all(const std::function<bool(const Arrival&)>& on_arrival) {
  struct Taking {
    const std::function<bool(const Arrival&)>& on_arrival;
    const TopicEntry* topic = nullptr;
    bool go_on = true;
  } taking{on_arrival};
  for (Ear& ear : ears_) {
    taking.topic = ear.topic;
    ear.reader.take(
        [](void* context, std::span<const std::uint8_t> cdr) {
          auto& t = *static_cast<Taking*>(context);
          if (t.go_on) t.go_on = t.on_arrival({*t.topic, cdr, wall_now(), monotonic_now()});
        },
        &taking);
  }
  return taking.go_on;
}

void Listener::run(const std::function<bool(const Arrival&)>& on_arrival, std::optional<Duration> limit,
                   Duration tick, const std::function<void()>& on_tick) {
  const Duration start = monotonic_now();
  Duration next_tick = start + tick;
  std::array<pollfd, 2> wait_on{pollfd{participant_.waker().file_descriptor(), POLLIN, 0},
                                pollfd{stop_.file_descriptor(), POLLIN, 0}};
  while (!stop_.requested()) {
    participant_.waker().clear();
    if (!take_all(on_arrival)) return;
    const Duration now = monotonic_now();
    if (limit && now - start >= *limit) return;
    if (now >= next_tick) {
      on_tick();
      next_tick += tick * ((now - next_tick) / tick + 1);
    }
    const Duration until = limit ? std::min(next_tick, start + *limit) : next_tick;
    const Duration left = std::max(until - monotonic_now(), Duration::zero());
    const timespec timeout{static_cast<time_t>(left / 1s), static_cast<long>((left % 1s).count())};
    ::ppoll(wait_on.data(), wait_on.size(), &timeout, nullptr);
  }
}

std::string Listener::account() const {
  bus::ReaderStatistics sum;
  for (const Ear& ear : ears_) {
    const bus::ReaderStatistics& s = ear.reader.statistics();
    sum.received += s.received;
    sum.replaced += s.replaced;
    sum.dropped_malformed += s.dropped_malformed;
    sum.dropped_overflow += s.dropped_overflow;
    sum.vendor_lost += s.vendor_lost;
    sum.vendor_rejected += s.vendor_rejected;
    sum.vendor_replaced += s.vendor_replaced;
  }
  std::string text = "received " + std::to_string(sum.received);
  const auto add = [&](const char* what, std::uint64_t count) {
    if (count > 0) text += std::string(", ") + what + " " + std::to_string(count);
  };
  add("dropped as malformed", sum.dropped_malformed);
  add("dropped over the queue's bound", sum.dropped_overflow);
  add("replaced by a newer one before this tool could take it", sum.replaced);
  add("lost on the way", sum.vendor_lost);
  add("rejected by the vendor", sum.vendor_rejected);
  add("replaced in the vendor's history", sum.vendor_replaced);
  const std::uint64_t missed = sum.dropped() + sum.dropped_by_vendor() + sum.replaced + sum.vendor_replaced;
  return text + (missed == 0 ? ", none dropped" : "");
}

int listen(Listener& listener, const TopicEntry& topic, const Session& session,
           const std::function<void(const Arrival&, const Decoded&)>& on_sample,
           const std::function<void()>& on_tick) {
  constexpr Duration patience = 2s;
  const std::string name(topic.info.name);
  std::fprintf(stderr, "%s on %s\n", name.c_str(), listener.ring().c_str());
  std::uint64_t good = 0;
  std::uint64_t malformed = 0;
  const Duration start = monotonic_now();
  bool hinted = false;
  const auto take = [&](const Arrival& arrival) {
    if (const auto decoded = topic.decode(arrival.cdr)) {
      on_sample(arrival, *decoded);
      ++good;
    } else {
      ++malformed;
    }
    return session.count == 0 || good < session.count;
  };
  const auto tick = [&] {
    on_tick();
    if (hinted || good > 0 || monotonic_now() - start < patience) return;
    hinted = true;
    std::fprintf(stderr, "%s: nothing yet, %u publishers on %s; 'eciton topic list' shows what is there\n",
                 name.c_str(), listener.writers(topic), listener.ring().c_str());
  };
  const auto limit = session.seconds > 0 ? std::optional(from_s(session.seconds)) : std::nullopt;
  listener.run(take, limit, from_s(session.tick_s), tick);
  std::fprintf(stderr, "%s: %s", name.c_str(), listener.account().c_str());
  if (malformed > 0)
    std::fprintf(stderr, ", not a sample of the type %llu", static_cast<unsigned long long>(malformed));
  std::fprintf(stderr, "\n");
  if (good >= session.count || listener.stopped_by_signal()) return 0;
  std::fprintf(stderr, "%s: only %llu of %llu samples in %g s\n", name.c_str(), static_cast<unsigned long long>(good),
               static_cast<unsigned long long>(session.count), session.seconds);
  return 1;
}

}  // namespace eciton::deploy
