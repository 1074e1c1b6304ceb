// The radio between hosts: which of them hears a frame, when, and what chance and the shared medium do to it.
// Pure: it is given the time and knows frames by size and slot only; the relay moves their bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/bus/vendors/sim_network/link.hpp"
#include "deploy/net/settings.hpp"

namespace eciton::net {

/// Per directed link, in frames.
struct LinkCounters {
  std::uint64_t sent = 0;  // meant for this receiver
  std::uint64_t delivered = 0;
  std::uint64_t lost = 0;        // by chance or by a cut
  std::uint64_t dropped = 0;     // by a bound: the backlog, or what is in flight; or refused by the receiver
  std::uint64_t duplicated = 0;  // second copies made
  std::uint64_t reordered = 0;   // delivered after a later one
  std::uint64_t bytes = 0;       // delivered
};

struct Frame {
  std::uint32_t from = 0;
  std::optional<std::uint32_t> to{};  // nothing: every other host
  std::uint32_t bytes = 0;
  std::uint32_t slot = 0;  // the relay's

  static constexpr std::uint32_t no_slot = 0xffffffffu;  // its bytes could not be kept: it is dropped
};

/// A copy of a frame on its way to one receiver.
struct Flight {
  Duration due{};
  std::uint64_t order = 0;     // of two that are due at one time, the earlier goes first
  std::uint64_t sequence = 0;  // on its link
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::uint32_t bytes = 0;
  std::uint32_t slot = 0;
  bool duplicate = false;
};

/// One thread. `send`, `next_due` and `land` are real-time safe.
class Air {
 public:
  static constexpr std::size_t flights_max = 1u << 16;

  /// The draws on a link depend on the seed, both names and the frames sent on it, on nothing else.
  Air(std::vector<std::string> hosts, std::uint64_t seed);

  const std::vector<std::string>& hosts() const { return hosts_; }
  std::optional<std::uint32_t> index_of(const std::string& host) const;

  const LinkSettings& link(std::uint32_t from, std::uint32_t to) const { return at(from, to).settings; }
  void set_link(std::uint32_t from, std::uint32_t to, const LinkSettings& settings);
  const MediumSettings& medium() const { return medium_; }
  void set_medium(const MediumSettings& settings) { medium_ = settings; }
  /// Hosts in different groups do not hear each other; those in none form one more group. What is in flight arrives.
  void partition(const std::vector<std::vector<std::uint32_t>>& groups);
  const std::vector<std::vector<std::uint32_t>>& groups() const { return groups_; }
  const LinkCounters& counters(std::uint32_t from, std::uint32_t to) const { return at(from, to).counters; }

  /// A frame goes on the air. Returns how many flights it makes: each lands once.
  std::uint32_t send(const Frame& frame, Duration now);
  std::optional<Duration> next_due() const;
  /// The next flight that is due, if there is one.
  std::optional<Flight> land(Duration now);
  /// The receiver's interface did not take it after all.
  void refuse(const Flight& flight);

 private:
  struct Link {
    LinkSettings settings;
    bus::sim_network::RandomStream random{0};
    bool in_burst = false;
    std::uint64_t sequence = 0;
    std::uint64_t landed = 0;
    Duration last_due{};
    LinkCounters counters;
  };
  struct Hearing {
    std::uint32_t to;
    bus::sim_network::Fate fate;
  };

  Link& at(std::uint32_t from, std::uint32_t to) { return links_[from * hosts_.size() + to]; }
  const Link& at(std::uint32_t from, std::uint32_t to) const { return links_[from * hosts_.size() + to]; }
  void draw(const Frame& frame, std::uint32_t to);
  bool occupy(std::uint32_t bytes, Duration now);
  std::uint32_t launch(const Frame& frame, const Hearing& hearing, Duration sent_at);
  std::uint32_t launch(Link& link, Flight flight);

  std::vector<std::string> hosts_;
  std::vector<Link> links_;
  MediumSettings medium_;
  Duration free_at_{};  // the end of the last frame on the air
  std::vector<std::vector<std::uint32_t>> groups_;
  std::vector<std::uint32_t> group_of_;
  std::vector<Hearing> hearing_;  // of the frame being sent
  std::vector<Flight> flights_;   // a heap
  std::uint64_t order_ = 0;
};

}  // namespace eciton::net
