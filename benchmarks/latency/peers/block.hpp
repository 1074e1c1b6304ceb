// What one end of a lane recorded of one block of samples, and what the block cost its process.
#pragma once

#include <atomic>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace eciton::bench {

/// Times are of CLOCK_MONOTONIC, in ns; 0: did not happen.
struct SampleRecord {
  std::int64_t planned_ns = 0;
  std::int64_t ready_ns = 0;  // when the sender came to wait for the instant: after it, it was held up
  std::int64_t sent_ns = 0;
  std::int64_t received_ns = 0;  // the first time
  std::uint32_t duplicates = 0;
};

/// Of the whole process, all threads.
struct Usage {
  std::int64_t cpu_ns = 0;
  std::int64_t voluntary_switches = 0;
  std::int64_t involuntary_switches = 0;
  std::int64_t allocations = -1;  // -1: not counted
  std::int64_t rss_bytes = 0;     // a level, not a difference
};
Usage usage_now();
Usage operator-(const Usage& after, const Usage& before);

struct BlockReport {
  std::vector<SampleRecord> records;
  Usage usage;
  std::int64_t refused = 0;  // by the transport, when sending
  std::int64_t corrupt = 0;  // arrived with another filling
  std::int64_t stale = 0;    // of another block
};

/// As one line that names the figures and one line for each record.
std::string to_text(const BlockReport& report);
/// The number of record lines that follow this first line; -1: it is none.
int parse_head(const std::string& line, BlockReport& report);
bool parse_record(const std::string& line, SampleRecord& record);

/// Filled by the thread that sends and the thread that receives, without locks or allocation.
class BlockRecorder {
 public:
  static constexpr std::uint32_t capacity = 1u << 16;

  BlockRecorder() : slots_(new Slot[capacity]) {}

  /// Between blocks only.
  void begin(std::uint32_t base, std::uint32_t count);

  void sending(std::uint32_t k, std::int64_t planned_ns, std::int64_t ready_ns, std::int64_t sent_ns) noexcept;
  void refused() noexcept { refused_.fetch_add(1, std::memory_order_relaxed); }
  void received(std::uint32_t sequence, std::int64_t now_ns, bool intact) noexcept;

  /// Samples received at least once.
  std::uint32_t received_count() const noexcept { return received_count_.load(std::memory_order_acquire); }
  BlockReport report() const;

 private:
  struct Slot {
    std::int64_t planned_ns, ready_ns, sent_ns;
    std::atomic<std::int64_t> received_ns;
    std::atomic<std::uint32_t> duplicates;
  };
  std::unique_ptr<Slot[]> slots_;
  std::atomic<std::uint32_t> base_{0};
  std::atomic<std::uint32_t> count_{0};
  std::atomic<std::uint32_t> received_count_{0};
  std::atomic<std::int64_t> refused_{0};
  std::atomic<std::int64_t> corrupt_{0};
  std::atomic<std::int64_t> stale_{0};
};

}  // namespace eciton::bench
