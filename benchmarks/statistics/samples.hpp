// What one measured thing gave: its raw values in the order of their times, and what did not arrive. Nothing
// is thrown away or averaged before it is here.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace eciton::bench {

struct Samples {
  std::string name = {};          // "ours.cyclonedds.wake.256"
  std::string unit = {};          // "us"
  std::vector<double> at_s = {};  // since the start of the run, one for each value, or empty
  std::vector<double> values = {};
  std::uint64_t sent = 0;  // 0: nothing was sent, values were taken
  std::uint64_t lost = 0;
  std::uint64_t duplicates = 0;
  bool partial = false;    // less was measured than was asked for
  std::string chart = {};  // those of one chart share a picture; empty: those of one unit
};

}  // namespace eciton::bench
