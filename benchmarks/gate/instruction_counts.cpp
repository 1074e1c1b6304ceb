// Reads callgrind's own format, of which only the totals of each dump matter.
#include "benchmarks/gate/instruction_counts.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace eciton::bench {
namespace {

constexpr double tolerance = 0.03;
constexpr const char* record = "benchmarks/gate/run --record";

std::vector<double> totals_of(const std::string& callgrind) {
  std::vector<double> totals;
  std::istringstream lines(callgrind);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("totals: ")) totals.push_back(std::strtod(line.c_str() + 8, nullptr));
  }
  return totals;
}

std::string percent(double ratio) {
  char text[32];
  std::snprintf(text, sizeof(text), "%+.2f %%", 100 * (ratio - 1));
  return text;
}

std::string keys_of(const Json& object) {
  std::string text;
  for (const auto& [key, value] : object.items()) text += (text.empty() ? "'" : ", '") + key + "'";
  return text.empty() ? "none" : text;
}

void compare_one(Verdict& verdict, const std::string& name, double count, const Json& baseline) {
  const double before = baseline.at(name).get<double>();
  const double ratio = count / before;
  const bool good = std::abs(ratio - 1) <= tolerance;
  verdict.table.rows.push_back({name, number_text(before), number_text(count), percent(ratio), good ? "" : "MISSED"});
  if (good) return;
  verdict.missed.push_back(name + ": " + number_text(count) + " instructions per step, " + percent(ratio) +
                           " against the recorded " + number_text(before) +
                           (ratio > 1 ? ": find out what costs more; if it must, record it with "
                                      : ": better; record it, or the next loss goes unseen: ") +
                           record);
}

}  // namespace

eciton::Result<InstructionCounts> read_counts(const std::string& ran, const std::string& callgrind) {
  std::istringstream lines(ran);
  InstructionCounts counts;
  std::string steps_text;
  std::getline(lines, counts.built_with);
  std::getline(lines, steps_text);
  const double steps = std::strtod(steps_text.c_str(), nullptr);
  const std::vector<double> totals = totals_of(callgrind);
  for (std::string name; std::getline(lines, name);) {
    const std::size_t index = counts.per_step.size();
    if (steps < 1 || index >= totals.size() || totals[index] < steps) {
      return Error{"callgrind counted nothing for " + name + ": it has " + std::to_string(totals.size()) +
                   " dumps; does it still find the function eciton_counted_steps?"};
    }
    counts.per_step.emplace_back(name, totals[index] / steps);
  }
  // One more at the program's end, with nothing in it.
  if (counts.per_step.empty() || totals.size() != counts.per_step.size() + 1) {
    return Error{"callgrind made " + std::to_string(totals.size()) + " dumps for " +
                 std::to_string(counts.per_step.size()) + " workloads, where one more than these is right"};
  }
  return counts;
}

Json with_recorded(Json baselines, const InstructionCounts& counts) {
  Json own = Json::object();
  for (const auto& [name, count] : counts.per_step) own[name] = count;
  baselines[counts.built_with] = own;
  return baselines;
}

Verdict compare(const InstructionCounts& counts, const Json& baselines) {
  Verdict verdict;
  verdict.table = {"Instructions per step, " + counts.built_with, {"", "recorded", "now", "change", ""}};
  if (!baselines.contains(counts.built_with)) {
    verdict.missed.push_back("no instruction counts are recorded for '" + counts.built_with +
                             "'; there are those of " + keys_of(baselines) +
                             ". Check out a revision that you trust and record them: " + record);
    return verdict;
  }
  const Json& baseline = baselines.at(counts.built_with);
  Json gone = baseline;
  for (const auto& [name, count] : counts.per_step) {
    gone.erase(name);
    if (baseline.contains(name)) {
      compare_one(verdict, name, count, baseline);
    } else {
      verdict.missed.push_back(name + ": no instruction count is recorded for it: " + record);
    }
  }
  for (const auto& [name, count] : gone.items()) {
    verdict.missed.push_back(name + ": recorded, but it is not run any more: " + record);
  }
  return verdict;
}

}  // namespace eciton::bench
