// Repetitions of one benchmark are its blocks: without any, nothing is said of its confidence.
#include "benchmarks/micro/micro_report.hpp"

#include <algorithm>
#include <cstdlib>

#include "benchmarks/statistics/summary.hpp"

namespace eciton::bench {
namespace {

constexpr const char* contact = "contact_wrench/";
using Kept = KeepingReporter::Kept;

Interval interval_of(const Kept& kept) {
  Blocks blocks;
  for (const double value : kept.cpu_ns) blocks.push_back({value});
  return median_interval(blocks, 1);
}

/// "contact_wrench/dense_qr/32" to dense_qr's point at 32.
void add_point(Curves& curves, const Kept& kept) {
  const std::size_t begin = std::string(contact).size(), end = kept.name.rfind('/');
  const std::string way = kept.name.substr(begin, end - begin);
  auto curve =
      std::find_if(curves.curves.begin(), curves.curves.end(), [&](const Curve& c) { return c.name == way; });
  if (curve == curves.curves.end()) curve = curves.curves.insert(curves.curves.end(), {way});
  curve->points.emplace_back(std::strtod(kept.name.c_str() + end + 1, nullptr), quantile(kept.cpu_ns, 0.5));
}

/// What each rival takes for what the recursion takes one of.
void add_ratios(Json& metrics, const Curves& curves) {
  for (const Curve& recursion : curves.curves) {
    if (recursion.name != "recursion") continue;
    for (const Curve& rival : curves.curves) {
      for (const auto& [n, ns] : rival.points) {
        for (const auto& [same_n, recursion_ns] : recursion.points) {
          if (n != same_n || rival.name == "recursion") continue;
          metrics["over_recursion." + rival.name + "." + std::to_string(static_cast<int>(n))] = ns / recursion_ns;
        }
      }
    }
  }
}

}  // namespace

KeepingReporter::KeepingReporter(const std::vector<std::string>& order) {
  for (const std::string& name : order) kept_.push_back({name});
}

std::vector<Kept> KeepingReporter::kept() const {
  std::vector<Kept> ran = kept_;
  std::erase_if(ran, [](const Kept& one) { return one.cpu_ns.empty(); });
  return ran;
}

void KeepingReporter::ReportRuns(const std::vector<Run>& runs) {
  ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
    const auto kept =
        std::find_if(kept_.begin(), kept_.end(), [&](const Kept& k) { return k.name == run.run_name.str(); });
    if (kept == kept_.end()) continue;
    kept->cpu_ns.push_back(run.GetAdjustedCPUTime());  // its unit is ns unless a benchmark asks for another
    if (const auto uses = run.counters.find("heap_uses"); uses != run.counters.end()) kept->heap_uses = uses->second;
  }
}

Result micro_result(const std::vector<Kept>& kept, const std::string& built_with) {
  Result result;
  result.title = "Steps of flight, piece by piece";
  result.command = "bench micro";
  result.clock = "processor";
  result.config["built_with"] = built_with;
  Table table{"Processor time per step", {"", "median, ns", "least, ns", "heap uses"}};
  Bars bars{"Processor time per step, median of the repetitions", "ns"};
  Curves curves{"Contact wrenches of a chain: the recursion and general solvers", "members", "ns"};
  for (const Kept& one : kept) {
    const Interval median = interval_of(one);
    table.rows.push_back({one.name, interval_text(median), number_text(quantile(one.cpu_ns, 0)),
                          one.heap_uses < 0 ? "–" : number_text(one.heap_uses)});
    result.metrics["cpu_ns." + one.name] = median.value;
    if (one.heap_uses >= 0) result.metrics["heap_uses." + one.name] = one.heap_uses;
    if (one.name.starts_with(contact)) {
      add_point(curves, one);
    } else {
      const std::size_t slash = one.name.find('/');
      bars.bars.push_back({one.name.substr(0, slash), one.name.substr(slash + 1), median});
    }
  }
  add_ratios(result.metrics, curves);
  if (!bars.bars.empty()) result.bars.push_back(std::move(bars));
  if (!curves.curves.empty()) result.curves.push_back(std::move(curves));
  result.tables.push_back(std::move(table));
  return result;
}

}  // namespace eciton::bench
