// Google Benchmark's runs as a result of ours: bars of what each step costs, growth of the contact-wrench solvers
// with the length of the chain.
#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "benchmarks/report/result.hpp"

namespace eciton::bench {

/// Prints as ever, and keeps what was run.
class KeepingReporter final : public benchmark::ConsoleReporter {
 public:
  /// Processor time of each repetition, ns.
  struct Kept {
    std::string name;
    std::vector<double> cpu_ns = {};
    double heap_uses = -1;  // per step; negative: not counted
  };

  /// `order`: of the names, however they are interleaved when run.
  explicit KeepingReporter(const std::vector<std::string>& order);
  void ReportRuns(const std::vector<Run>& runs) override;
  /// Those that were run.
  std::vector<Kept> kept() const;

 private:
  std::vector<Kept> kept_;
};

Result micro_result(const std::vector<KeepingReporter::Kept>& kept, const std::string& built_with);

}  // namespace eciton::bench
