// Which services of a module are silent, by the stamps of their heartbeats and the time of whoever watches. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/bounded.hpp"
#include "core/base/time.hpp"

namespace eciton::runtime {

struct ServiceWatchConfig {
  Duration beat = std::chrono::milliseconds(10);      // between two heartbeats
  Duration patience = std::chrono::milliseconds(46);  // with the watcher's pace of 2 ms: noticed within 50 ms
  Duration settling = std::chrono::seconds(1);        // after its first heartbeat, its return or a gap, a service ...
  Duration settling_patience =
      std::chrono::seconds(1);  // ... may be silent so long: it, or what it waits for, starts
};

/// A service counts from its first heartbeat on, until it says farewell. Real-time safe; one thread.
class ServiceWatch {
 public:
  static constexpr std::size_t bound = 16;  // services of one module; further ones are not watched

  struct Notice {
    std::string_view service;
    bool silent = false;  // false: it is back
    Duration silence{};   // since its last heartbeat; how long it was
  };

  /// `period`: of the watcher's own steps.
  explicit ServiceWatch(Duration period, const ServiceWatchConfig& config = {}) : period_(period), config_(config) {}

  /// First in every step. When the step comes late by more than a beat, or the clock was set, the time since the last
  /// one counts for nobody: who was held up cannot tell who else was.
  void begin(TimePoint now) noexcept;
  /// `key` identifies the service; `stamp` is when it was sent.
  void hear(std::uint32_t key, std::string_view service, TimePoint stamp, bool farewell) noexcept;
  /// After the step's heartbeats, again and again until there is none. Valid until the next `hear`.
  std::optional<Notice> next_notice() noexcept;

  std::size_t silent_services() const noexcept;
  /// How often a service fell silent.
  std::uint64_t silences() const noexcept { return silences_; }

 private:
  struct Watched {
    std::uint32_t key = 0;
    BoundedString<31> service;  // empty: a free place
    TimePoint alive_at{};
    TimePoint settled_at{};
    bool silent = false;
    std::optional<Duration> back_after;  // yet to be told
  };

  Duration period_;
  ServiceWatchConfig config_;
  std::array<Watched, bound> watched_{};
  std::optional<TimePoint> now_;
  std::uint64_t silences_ = 0;
};

}  // namespace eciton::runtime
