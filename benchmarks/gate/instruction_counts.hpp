// Instructions per step of the hot workloads, against those recorded. They are the same from run to run and
// from machine to machine, but not from compiler to compiler: each has a baseline of its own.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "benchmarks/gate/verdict.hpp"
#include "core/base/result.hpp"

namespace eciton::bench {

struct InstructionCounts {
  std::string built_with;                                // processor, compiler, flags
  std::vector<std::pair<std::string, double>> per_step;  // in the order they ran
};

/// `ran`: what eciton-bench-hot-path wrote. `callgrind`: the dumps, one for each workload and one at the end.
eciton::Result<InstructionCounts> read_counts(const std::string& ran, const std::string& callgrind);

/// The baselines with these counts in them; those of other compilers stay.
Json with_recorded(Json baselines, const InstructionCounts& counts);

/// Missed: more than 3 % off its baseline either way (better is to be recorded, or the next loss goes unseen), a
/// workload without a baseline or a baseline without its workload, or none recorded for what built it.
Verdict compare(const InstructionCounts& counts, const Json& baselines);

}  // namespace eciton::bench
