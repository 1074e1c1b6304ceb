// Charts as inline SVG. Colours and type come from the page's style (classes c0 to c7), so that a chart is
// as readable in the dark.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/report/result.hpp"

namespace eciton::bench {

using SampleSet = std::vector<const Samples*>;

/// Value over percentile, the percentile on a logarithmic tail: each further nine takes the same room. A line
/// ends where its count resolves no more.
std::string distribution_chart(const SampleSet& samples);
/// One panel for each, on common axes: the median of each stretch of time, and its least and greatest value. Where
/// nothing was measured for long (other variants had their turn) the line breaks.
/// Empty where no sample has a time.
std::string time_chart(const SampleSet& samples);
std::string curves_chart(const Curves& curves);
/// Rows within their groups, whiskers from low to high.
std::string bars_chart(const Bars& bars);

}  // namespace eciton::bench
