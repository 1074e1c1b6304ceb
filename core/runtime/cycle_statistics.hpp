// How regularly a service steps and how long a step takes: over the last second for its heartbeat, and
// over the whole run for the table a process prints when it ends. Fixed memory; recording is real-time safe.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/time.hpp"
#include "core/runtime/duration_histogram.hpp"
#include "idl/fleet.hpp"

namespace eciton::runtime {

class CycleStatistics {
 public:
  /// Of the cycles that started in the last second.
  struct Recent {
    std::uint64_t cycles = 0;
    Duration period_mean{};  // without two starts in the window: the time since the last start
    Duration jitter_p99{};   // of |this period less the one before|
    Duration execution_mean{};
    Duration execution_max{};
  };
  struct Distribution {
    Duration p50{}, p99{}, max{};
  };

  /// A step began at `start` (since the epoch of the clock that paces the executor) and took `execution`.
  void record(Duration start, Duration execution) noexcept;
  /// Whole periods that were skipped, or steps that took longer than they may.
  void count_overruns(std::uint64_t count) noexcept { overruns_ += count; }
  /// A triggered service stepped without a sample.
  void count_timeout() noexcept { ++timeouts_; }

  std::uint64_t cycles() const { return cycles_; }
  std::uint64_t overruns() const { return overruns_; }
  std::uint64_t timeouts() const { return timeouts_; }

  Recent recent(Duration now) const noexcept;
  Duration period_mean() const;
  Duration execution_mean() const;
  Distribution jitter() const { return distribution(jitter_, jitter_max_); }
  Distribution execution() const { return distribution(execution_, execution_max_); }

  /// Sets what a heartbeat says of the cycles. Real-time safe.
  void fill(msg::Heartbeat& heartbeat, Duration now) const noexcept;

  /// For people: one line per service under one heading, without line ends.
  static std::string table_heading();
  std::string table_line(std::string_view service) const;

 private:
  /// The window slides by a tenth.
  static constexpr Duration slice_length = std::chrono::milliseconds(100);
  static constexpr std::size_t slices_in_window = 10;

  struct Slice {
    std::int64_t index = -1;  // since the clock's epoch
    std::uint32_t cycles = 0;
    std::uint32_t periods = 0;
    Duration period_sum{};
    Duration execution_sum{};
    Duration execution_max{};
    DurationHistogram<std::uint16_t> jitter;
  };
  using Histogram = DurationHistogram<std::uint64_t>;

  Slice& slice_at(Duration t) noexcept;
  static Distribution distribution(const Histogram& histogram, Duration max);

  std::array<Slice, slices_in_window> slices_;
  std::uint64_t cycles_ = 0;
  std::uint64_t overruns_ = 0;
  std::uint64_t timeouts_ = 0;
  Duration first_start_{};
  Duration last_start_{};
  Duration last_period_{};
  Duration jitter_max_{};
  Duration execution_sum_{};
  Duration execution_max_{};
  Histogram jitter_;
  Histogram execution_;
};

}  // namespace eciton::runtime
