// Confidence of a median and of a ratio, by resampling whole blocks: neighbouring samples share their weather,
// so a single one is worth less than it seems, a block is not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace eciton::bench {

/// Of 95 % confidence. Without values all are NaN; of one block nothing is known: low and high are infinite.
struct Interval {
  double low = 0, value = 0, high = 0;
};

using Blocks = std::vector<std::vector<double>>;

/// Of the pooled values' median. The same seed gives the same bits.
Interval median_interval(const Blocks& blocks, std::uint64_t seed);

/// The quantile of all blocks over the quantile of all baseline blocks. As many blocks as baseline blocks: block i
/// and baseline block i were measured side by side, and are drawn together, so that what disturbs both cancels.
Interval ratio_interval(const Blocks& blocks, const Blocks& baseline_blocks, double fraction, std::uint64_t seed);

/// Cuts a run into `count` neighbouring blocks of nearly equal size; fewer if there are fewer values.
Blocks cut(const std::vector<double>& values, std::size_t count);

/// The order in which variants are run: forward and backward in turn (for two of them ABBA), so that a drift
/// that is linear in time falls on all of them alike. `rounds` × `variants` indices.
std::vector<std::size_t> abba_order(std::size_t variants, std::size_t rounds);

}  // namespace eciton::bench
