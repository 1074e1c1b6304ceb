// A tool's ear on one ring: hands over samples of chosen topics as they arrive, until told to stop, by a
// signal, a time or a count, and says at the end what was lost.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "core/bus/participant.hpp"
#include "core/runtime/stop_signal.hpp"
#include "deploy/command/ring_options.hpp"
#include "deploy/command/topic_catalogue.hpp"

namespace eciton::deploy {

/// One sample, when the tool took it: on the wall clock, and on the monotonic one.
struct Arrival {
  const TopicEntry& topic;
  std::span<const std::uint8_t> cdr;
  TimePoint wall;
  Duration monotonic;
};

class Listener {
 public:
  /// Joins the ring; throws BadInput. `depth`: samples of each key that wait at the most until the tool takes them.
  Listener(const RingOptions& ring, const std::string& tool, const std::vector<const TopicEntry*>& topics,
           std::uint32_t depth = 0);

  /// Gives each arrival to `on_arrival` until that returns false, a signal asks to stop, or `limit` is over;
  /// `on_tick` is called each `tick`.
  void run(const std::function<bool(const Arrival&)>& on_arrival, std::optional<Duration> limit, Duration tick,
           const std::function<void()>& on_tick);

  bool stopped_by_signal() const { return stop_.requested(); }
  std::string ring() const { return ring_; }
  /// Writers of this topic matched now.
  std::uint32_t writers(const TopicEntry& topic) const;
  const bus::ReaderStatistics& statistics(const TopicEntry& topic) const;
  /// "received 512; dropped: none", over all topics.
  std::string account() const;

 private:
  struct Ear {
    const TopicEntry* topic;
    bus::RawReader reader;
  };
  const Ear& ear_of(const TopicEntry& topic) const;
  /// Returns whether to go on.
  bool take_all(const std::function<bool(const Arrival&)>& on_arrival);

  runtime::StopFlag stop_;
  runtime::StopOnSignals on_signals_{stop_};
  std::string ring_;
  bus::Participant participant_;
  std::vector<Ear> ears_;
};

/// When a tool that listens to one topic ends of itself, and how often it reports meanwhile.
struct Session {
  std::uint64_t count = 0;  // good samples; 0: no end
  double seconds = 0;       // 0: no end
  double tick_s = 1;
};

/// Runs a tool on one topic. `on_sample` gets each sample that is well-formed. Tells people on standard error
/// where it listens, when nobody publishes, and at the end what was lost. Returns the exit status: 1 when the
/// seconds were over before the count was reached.
int listen(Listener& listener, const TopicEntry& topic, const Session& session,
           const std::function<void(const Arrival&, const Decoded&)>& on_sample,
           const std::function<void()>& on_tick);

}  // namespace eciton::deploy
