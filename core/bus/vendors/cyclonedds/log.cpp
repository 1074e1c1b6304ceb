// The vendor's warnings and errors to stderr, a bounded number per interval; how many were left out is said.
#include "core/bus/vendors/cyclonedds/log.hpp"

#include <chrono>
#include <cstdint>
#include <cstdio>

#include "core/bus/vendors/cyclonedds/vendor.hpp"

#include <dds/ddsrt/log.h>

namespace eciton::bus::cyclonedds {
namespace {

using Clock = std::chrono::steady_clock;
constexpr Clock::duration kInterval = std::chrono::seconds(10);
constexpr std::uint32_t kLinesPerInterval = 5;

struct Limit {
  Clock::time_point since{};
  std::uint32_t lines = 0;
};
Limit limit;  // the vendor calls its sink under a lock of its own

void write_line(void*, const dds_log_data_t* line) {
  const Clock::time_point now = Clock::now();
  if (now - limit.since > kInterval) {
    if (limit.lines > kLinesPerInterval) {
      std::fprintf(stderr, "cyclonedds: %u more lines in %ld s\n", limit.lines - kLinesPerInterval,
                   static_cast<long>(std::chrono::duration_cast<std::chrono::seconds>(now - limit.since).count()));
    }
    limit = {now, 0};
  }
  if (++limit.lines > kLinesPerInterval) return;
  std::fprintf(stderr, "cyclonedds: %s", line->message);
}

}  // namespace

void limit_log() { dds_set_log_sink(write_line, nullptr); }
void restore_log() { dds_set_log_sink(nullptr, nullptr); }

}  // namespace eciton::bus::cyclonedds
