// How a peer's clock stands to ours, from stamps that the peer echoes: as NTP does it (RFC 5905, section 8).
// The error is at most half the round trip, however lopsided the two ways are; the least one of a window counts.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/base/time.hpp"

namespace eciton::radio {

struct PeerClockConfig {
  Duration window = 60s;         // what is older no longer counts
  double drift = 50e-6;          // of one clock against the other, at the most: two cheap oscillators
  Duration round_trip_max = 5s;  // a longer one says nothing worth keeping
};

struct ClockOffset {
  Duration offset;  // the peer's clock less ours
  Duration bound;   // the true offset is within this of it
};

/// Stamps named by whose clock they are on. Real-time safe.
class PeerClock {
 public:
  PeerClock() = default;
  explicit PeerClock(const PeerClockConfig& config) : config_(config) {}

  /// Anything of the peer's, stamped by it, came in now.
  void hear(TimePoint now, TimePoint peer_stamp);

  /// The peer, at `peer_sent`, says that it received our sample stamped `our_stamp` at `peer_received`.
  void echo(TimePoint now, TimePoint peer_sent, TimePoint our_stamp, TimePoint peer_received);

  /// Nothing before the first echo, and after a window without one.
  std::optional<ClockOffset> offset(TimePoint now) const;
  /// How old something is that the peer stamped; never negative. Nothing while the offset is not known.
  std::optional<Duration> age(TimePoint now, TimePoint peer_stamp) const;

  std::optional<TimePoint> last_heard() const { return last_heard_; }
  /// The peer's clock, or ours, jumped: what was known before was dropped.
  std::uint32_t steps() const { return steps_; }
  /// Echoes that no two clocks could have made.
  std::uint32_t rejected() const { return rejected_; }

 private:
  struct Measurement {
    TimePoint at;  // our clock
    Duration offset;
    Duration half_round_trip;
  };
  static constexpr std::size_t slots = 8;  // the best of each eighth of the window

  Duration bound_of(const Measurement& m, TimePoint now) const;
  const Measurement* best(TimePoint now) const;
  void keep(const Measurement& m);

  PeerClockConfig config_;
  std::array<std::optional<Measurement>, slots> measurements_;
  std::size_t slot_ = 0;
  TimePoint slot_begin_{};
  std::optional<TimePoint> last_heard_;
  std::uint32_t steps_ = 0;
  std::uint32_t rejected_ = 0;
};

}  // namespace eciton::radio
