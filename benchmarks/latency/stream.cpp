// From the two ends' records to times.
#include "benchmarks/latency/stream.hpp"

#include <algorithm>

namespace eciton::bench {
namespace {

double us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

}  // namespace

void Spent::add(const Usage& usage) {
  cpu_us += us(usage.cpu_ns);
  switches += static_cast<double>(usage.voluntary_switches + usage.involuntary_switches);
  allocations += static_cast<double>(std::max<std::int64_t>(usage.allocations, 0));
  allocations_counted = allocations_counted && usage.allocations >= 0;
  rss_MB_max = std::max(rss_MB_max, static_cast<double>(usage.rss_bytes) * 1e-6);
}

void Stream::add(const Block& block, std::int64_t start_of_run_ns) {
  std::vector<double>& times = round_trip_us.emplace_back();
  for (std::size_t k = 0; k < block.ping.records.size(); ++k) {
    const SampleRecord& sample = block.ping.records[k];
    if (sample.sent_ns == 0) continue;
    ++sent;
    const bool was_held_up = sample.ready_ns > sample.planned_ns;
    held_up += was_held_up ? 1 : 0;
    late_us.push_back(us(sample.sent_ns - sample.planned_ns));
    duplicates += sample.duplicates;
    if (sample.received_ns == 0) {
      ++lost;
      continue;
    }
    const std::int64_t begin_ns = was_held_up ? sample.planned_ns : sample.sent_ns;
    times.push_back(us(sample.received_ns - begin_ns));
    from_plan_us.push_back(us(sample.received_ns - sample.planned_ns));
    at_s.push_back(us(sample.planned_ns - start_of_run_ns) * 1e-6);
    if (k >= block.echo.records.size() || block.echo.records[k].received_ns == 0) continue;
    const std::int64_t turned_ns = block.echo.records[k].received_ns;
    there_us.push_back(us(turned_ns - begin_ns));
    back_us.push_back(us(sample.received_ns - turned_ns));
  }
  corrupt += static_cast<std::uint64_t>(block.ping.corrupt + block.echo.corrupt);
  refused += static_cast<std::uint64_t>(block.ping.refused + block.echo.refused);
  ping.add(block.ping.usage);
  echo.add(block.echo.usage);
}

}  // namespace eciton::bench
