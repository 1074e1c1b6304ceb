// Control of the in-process network behind the plugin "sim_network": link quality, partitions, virtual
// time. The endpoints are created through core/bus/plugin.h; both see the same networks, one per domain.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/time.hpp"

namespace eciton::bus::sim_network {

/// Of one directed pair of participants. Order per writer and reader is kept except by `reordering`.
/// Best-effort readers are given duplicates and late samples, which a DDS vendor would filter: services
/// must stand them. Reliable readers get every sample once, in order.
struct LinkQuality {
  Duration delay{};
  Duration jitter{};       // delay is uniform in delay ± jitter, not below 0, as tc-netem has it
  double loss = 0;         // probabilities, per sample and reader; reliable: per attempt
  double duplication = 0;  // a second copy, with a delay of its own
  double reordering = 0;   // the sample is held back for `hold`; later ones overtake it
  Duration hold = 10ms;

  bool operator==(const LinkQuality&) const = default;
};

/// immediate_wall: delays run on the steady clock, thread-safe. virtual_time: one thread, `advance`.
enum class Pacing { immediate_wall, virtual_time };

/// Counted per (sample, reader).
struct [[gnu::visibility("default")]] Statistics {
  std::uint64_t sent = 0;           // handed to the link; held back by a partition: once it is healed
  std::uint64_t delivered = 0;      // into the reader's queue
  std::uint64_t lost = 0;           // by chance, by a partition (best effort), or after the last attempt
  std::uint64_t retransmitted = 0;  // attempts after the first
  std::uint64_t superseded = 0;     // reliable: replaced in the writer's history before an attempt arrived
  std::uint64_t duplicated = 0;     // second copies made; a reliable reader never sees them
  std::uint64_t reordered = 0;      // delivered after a later sample of the same writer
  std::uint64_t replaced = 0;       // taken out of a reader's queue unread: keep last
  std::uint64_t dropped = 0;        // by a bound: samples in flight, or keys of a reader

  Statistics& operator+=(const Statistics& other);
  bool operator==(const Statistics&) const = default;
};

class Medium;

/// The network of one domain: created by its first participant or by `of`, dropped by `reset_all`.
class [[gnu::visibility("default")]] Network {
 public:
  static Network& of(std::uint32_t domain);
  /// Start-up and end of a run only. Throws std::logic_error while a participant lives.
  static void reset_all();

  explicit Network(std::uint32_t domain);
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// Before the first participant (else std::logic_error). Without it: seed 0, immediate_wall.
  void configure(std::uint64_t seed, Pacing pacing);
  /// Of all pairs without a quality of their own.
  void set_default_link(const LinkQuality& quality);
  void set_link(std::string_view from, std::string_view to, const LinkQuality& quality);

  /// Participants in different groups do not reach each other; those not named form one more group.
  /// What is in flight between groups is cut off. Best-effort samples are lost; reliable ones wait in the
  /// writer's history (keep last) until healed. Leases do not expire: endpoints stay matched.
  void partition(const std::vector<std::vector<std::string>>& groups);
  void heal();

  /// Virtual time: delivers what is due, in the order (time, sequence). Time never goes back.
  void advance(TimePoint now);
  /// When the next sample in flight is due.
  std::optional<TimePoint> next_delivery() const;

  Statistics statistics() const;
  Statistics statistics(std::string_view from, std::string_view to) const;
  /// Pairs of endpoints of one topic that differ in type or key, or whose QoS does not fit.
  std::uint64_t mismatched() const;
  std::uint64_t writes_refused() const;  // malformed, more keys than the writer's bound, or no slot

  Medium& medium() { return *medium_; }

 private:
  std::unique_ptr<Medium> medium_;
};

}  // namespace eciton::bus::sim_network
