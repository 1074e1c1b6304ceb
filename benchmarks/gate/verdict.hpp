// What the gate says of one kind of figure: a table of all of them, and a sentence for each that is missed.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/report/result.hpp"

namespace eciton::bench {

struct Verdict {
  Table table;
  std::vector<std::string> missed;
};

}  // namespace eciton::bench
