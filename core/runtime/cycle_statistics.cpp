// The sliding window is ten slices of a tenth of a second, each with its own histogram; the oldest is reused.
#include "core/runtime/cycle_statistics.hpp"

#include <algorithm>
#include <cstdio>

namespace eciton::runtime {

namespace {

double to_us(Duration d) { return static_cast<double>(d.count()) * 1e-3; }

}  // namespace

CycleStatistics::Slice& CycleStatistics::slice_at(Duration t) noexcept {
  const std::int64_t index = t / slice_length;
  Slice& slice = slices_[static_cast<std::size_t>(index) % slices_.size()];
  if (slice.index != index) {
    slice.index = index;
    slice.cycles = 0;
    slice.periods = 0;
    slice.period_sum = slice.execution_sum = slice.execution_max = Duration::zero();
    slice.jitter.clear();
  }
  return slice;
}

void CycleStatistics::record(Duration start, Duration execution) noexcept {
  Slice& slice = slice_at(start);
  ++slice.cycles;
  slice.execution_sum += execution;
  slice.execution_max = std::max(slice.execution_max, execution);
  execution_sum_ += execution;
  execution_max_ = std::max(execution_max_, execution);
  execution_.add(execution);
  if (cycles_ == 0) first_start_ = start;
  if (cycles_ >= 1) {
    const Duration period = start - last_start_;
    ++slice.periods;
    slice.period_sum += period;
    if (cycles_ >= 2) {
      const Duration jitter = std::chrono::abs(period - last_period_);
      slice.jitter.add(jitter);
      jitter_.add(jitter);
      jitter_max_ = std::max(jitter_max_, jitter);
    }
    last_period_ = period;
  }
  last_start_ = start;
  ++cycles_;
}

CycleStatistics::Recent CycleStatistics::recent(Duration now) const noexcept {
  Recent recent;
  const std::int64_t newest = now / slice_length;
  std::uint64_t periods = 0;
  Duration period_sum{}, execution_sum{};
  DurationHistogram<std::uint32_t> jitter;
  for (const Slice& slice : slices_) {
    if (slice.index < 0 || slice.index + static_cast<std::int64_t>(slices_in_window) <= newest) continue;
    recent.cycles += slice.cycles;
    periods += slice.periods;
    period_sum += slice.period_sum;
    execution_sum += slice.execution_sum;
    recent.execution_max = std::max(recent.execution_max, slice.execution_max);
    jitter.add(slice.jitter);
  }
  if (periods > 0) recent.period_mean = period_sum / static_cast<std::int64_t>(periods);
  if (periods == 0 && cycles_ > 0) recent.period_mean = now - last_start_;
  if (recent.cycles > 0) recent.execution_mean = execution_sum / static_cast<std::int64_t>(recent.cycles);
  recent.jitter_p99 = jitter.quantile(0.99);
  return recent;
}

Duration CycleStatistics::period_mean() const {
  return cycles_ < 2 ? Duration::zero() : (last_start_ - first_start_) / static_cast<std::int64_t>(cycles_ - 1);
}

Duration CycleStatistics::execution_mean() const {
  return cycles_ == 0 ? Duration::zero() : execution_sum_ / static_cast<std::int64_t>(cycles_);
}

CycleStatistics::Distribution CycleStatistics::distribution(const Histogram& histogram, Duration max) {
  // A bin's middle may lie beyond the greatest sample.
  return {std::min(histogram.quantile(0.5), max), std::min(histogram.quantile(0.99), max), max};
}

void CycleStatistics::fill(msg::Heartbeat& heartbeat, Duration now) const noexcept {
  const Recent last_second = recent(now);
  heartbeat.cycles = cycles_;
  heartbeat.overruns = overruns_;
  heartbeat.period_s = to_s(last_second.period_mean);
  heartbeat.jitter_s_p99 = to_s(last_second.jitter_p99);
  heartbeat.execution_s_mean = to_s(last_second.execution_mean);
  heartbeat.execution_s_max = to_s(last_second.execution_max);
}

std::string CycleStatistics::table_heading() {
  return "service        cycles  period_us | jitter_us  p50     p99      max | execution_us  mean    p99      max "
         "|"
         " overruns timeouts";
}

std::string CycleStatistics::table_line(std::string_view service) const {
  char line[256];
  const Distribution j = jitter();
  const Distribution e = execution();
  std::snprintf(line, sizeof line,
                "%-14.*s %9llu %10.1f |   %10.1f %7.1f %8.1f |        %10.1f %6.1f %8.1f | %8llu %8llu",
                static_cast<int>(service.size()), service.data(), static_cast<unsigned long long>(cycles_),
                to_us(period_mean()), to_us(j.p50), to_us(j.p99), to_us(j.max), to_us(execution_mean()), to_us(e.p99),
                to_us(e.max), static_cast<unsigned long long>(overruns_), static_cast<unsigned long long>(timeouts_));
  return line;
}

}  // namespace eciton::runtime
