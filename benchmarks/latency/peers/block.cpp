// Recording into slots made beforehand; text is made only after a block.
#include "benchmarks/latency/peers/block.hpp"

#include <dlfcn.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cinttypes>
#include <cstdio>

namespace eciton::bench {
namespace {

std::int64_t to_ns(const timeval& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + std::int64_t{time.tv_usec} * 1000;
}

std::int64_t rss_bytes() {
  long long total = 0, resident = 0;
  std::FILE* file = std::fopen("/proc/self/statm", "re");
  if (file == nullptr) return 0;
  const int got = std::fscanf(file, "%lld %lld", &total, &resident);
  std::fclose(file);
  return got == 2 ? resident * ::sysconf(_SC_PAGESIZE) : 0;
}

/// Of the heap counter, where it is preloaded.
std::int64_t allocations() {
  using Count = std::uint64_t (*)();
  static const auto count = reinterpret_cast<Count>(::dlsym(RTLD_DEFAULT, "eciton_bench_allocations"));
  return count == nullptr ? -1 : static_cast<std::int64_t>(count());
}

}  // namespace

Usage usage_now() {
  rusage of_process{};
  ::getrusage(RUSAGE_SELF, &of_process);
  return {to_ns(of_process.ru_utime) + to_ns(of_process.ru_stime), of_process.ru_nvcsw, of_process.ru_nivcsw,
          allocations(), rss_bytes()};
}

Usage operator-(const Usage& after, const Usage& before) {
  return {after.cpu_ns - before.cpu_ns, after.voluntary_switches - before.voluntary_switches,
          after.involuntary_switches - before.involuntary_switches,
          after.allocations < 0 ? -1 : after.allocations - before.allocations, after.rss_bytes};
}

std::string to_text(const BlockReport& report) {
  char line[256];
  const Usage& used = report.usage;
  std::snprintf(line, sizeof line,
                "block %zu %" PRId64 " %" PRId64 " %" PRId64 " %" PRId64 " %" PRId64 " %" PRId64 " %" PRId64
                " %" PRId64 "\n",
                report.records.size(), used.cpu_ns, used.voluntary_switches, used.involuntary_switches,
                used.allocations, used.rss_bytes, report.refused, report.corrupt, report.stale);
  std::string text = line;
  for (const SampleRecord& each : report.records) {
    std::snprintf(line, sizeof line, "%" PRId64 " %" PRId64 " %" PRId64 " %" PRId64 " %" PRIu32 "\n", each.planned_ns,
                  each.ready_ns, each.sent_ns, each.received_ns, each.duplicates);
    text += line;
  }
  return text;
}

int parse_head(const std::string& line, BlockReport& report) {
  std::size_t count = 0;
  Usage& used = report.usage;
  const int got = std::sscanf(line.c_str(),
                              "block %zu %" SCNd64 " %" SCNd64 " %" SCNd64 " %" SCNd64 " %" SCNd64 " %" SCNd64
                              " %" SCNd64 " %" SCNd64,
                              &count, &used.cpu_ns, &used.voluntary_switches, &used.involuntary_switches,
                              &used.allocations, &used.rss_bytes, &report.refused, &report.corrupt, &report.stale);
  return got == 9 && count <= BlockRecorder::capacity ? static_cast<int>(count) : -1;
}

bool parse_record(const std::string& line, SampleRecord& record) {
  return std::sscanf(line.c_str(), "%" SCNd64 " %" SCNd64 " %" SCNd64 " %" SCNd64 " %" SCNu32, &record.planned_ns,
                     &record.ready_ns, &record.sent_ns, &record.received_ns, &record.duplicates) == 5;
}

void BlockRecorder::begin(std::uint32_t base, std::uint32_t count) {
  count_.store(0, std::memory_order_release);  // what comes meanwhile is stale
  for (std::uint32_t k = 0; k < count; ++k) {
    Slot& slot = slots_[k];
    slot.planned_ns = slot.ready_ns = slot.sent_ns = 0;
    slot.received_ns.store(0, std::memory_order_relaxed);
    slot.duplicates.store(0, std::memory_order_relaxed);
  }
  received_count_.store(0);
  refused_.store(0);
  corrupt_.store(0);
  stale_.store(0);
  base_.store(base, std::memory_order_release);
  count_.store(count, std::memory_order_release);
}

void BlockRecorder::sending(std::uint32_t k, std::int64_t planned_ns, std::int64_t ready_ns,
                            std::int64_t sent_ns) noexcept {
  slots_[k].planned_ns = planned_ns;
  slots_[k].ready_ns = ready_ns;
  slots_[k].sent_ns = sent_ns;
}

void BlockRecorder::received(std::uint32_t sequence, std::int64_t now_ns, bool intact) noexcept {
  const std::uint32_t k = sequence - base_.load(std::memory_order_acquire);
  if (k >= count_.load(std::memory_order_acquire)) {
    stale_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  if (!intact) corrupt_.fetch_add(1, std::memory_order_relaxed);
  Slot& slot = slots_[k];
  if (slot.received_ns.load(std::memory_order_relaxed) != 0) {
    slot.duplicates.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  slot.received_ns.store(now_ns, std::memory_order_relaxed);
  received_count_.fetch_add(1, std::memory_order_release);
}

BlockReport BlockRecorder::report() const {
  BlockReport report;
  const std::uint32_t count = count_.load(std::memory_order_acquire);
  report.records.reserve(count);
  for (std::uint32_t k = 0; k < count; ++k) {
    const Slot& slot = slots_[k];
    report.records.push_back({slot.planned_ns, slot.ready_ns, slot.sent_ns,
                              slot.received_ns.load(std::memory_order_relaxed),
                              slot.duplicates.load(std::memory_order_relaxed)});
  }
  report.refused = refused_.load();
  report.corrupt = corrupt_.load();
  report.stale = stale_.load();
  return report;
}

}  // namespace eciton::bench
