// The figures that are gated, and whether a run reached them: ratios of two times of one run of the
// micro-benchmarks, and metrics of a measuring verb's JSON object. Never an absolute time.
#pragma once

#include "benchmarks/gate/verdict.hpp"
#include "core/base/result.hpp"

namespace eciton::bench {

/// `results`: Google Benchmark's JSON; of a benchmark's repetitions the quickest counts, since what disturbs a run
/// only adds to it. `figures`: [{"figure", "of": name or [names: the least], "over": name, "at_least"|"at_most"}].
/// The Error names what is wrong with the figures; a benchmark that did not run is a figure missed.
eciton::Result<Verdict> judge_ratios(const Json& results, const Json& figures);

/// `measurement`: what --json FILE wrote. `figures`: [{"figure", "metrics": shell pattern, "at_least"|"at_most"}]. A
/// pattern that no metric fits, and a metric without a value, is a figure missed; so is a run that was cut short.
eciton::Result<Verdict> judge_metrics(const Json& measurement, const Json& figures);

}  // namespace eciton::bench
