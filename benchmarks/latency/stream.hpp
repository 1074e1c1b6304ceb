// All that one lane gave for one cell: block by block, so that blocks can be resampled and set against those of
// another lane that were measured beside them.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/latency/lane.hpp"
#include "benchmarks/latency/plan.hpp"
#include "benchmarks/statistics/bootstrap.hpp"

namespace eciton::bench {

/// What a process of a lane spent on the samples of a stream.
struct Spent {
  double cpu_us = 0;
  double switches = 0;
  double allocations = 0;
  bool allocations_counted = true;
  double rss_MB_max = 0;
  void add(const Usage& usage);
};

struct Stream {
  std::string lane, label;
  Kind kind = Kind::foreign;
  std::string vendor, delivery;
  Cell cell;

  /// µs. A sample's time begins when its sending does; where the sender was held up past the planned instant, by the
  /// transport or by what it received, it begins at that instant. Ratios are of these.
  Blocks round_trip_us;
  /// µs from the planned instant, whatever kept the sender: what a user waits for.
  std::vector<double> from_plan_us, at_s;
  /// µs, there and back; both ends read one clock.
  std::vector<double> there_us, back_us;
  std::vector<double> late_us;  // of the sender
  std::uint64_t sent = 0, lost = 0, duplicates = 0, corrupt = 0, refused = 0, held_up = 0;
  Spent ping, echo;
  std::size_t blocks_asked = 0;
  std::string trouble;

  void add(const Block& block, std::int64_t start_of_run_ns);
  bool partial() const { return round_trip_us.size() < blocks_asked; }
  std::string name() const { return lane + "." + cell.suffix(); }
};

}  // namespace eciton::bench
