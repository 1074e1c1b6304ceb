// Each figure is a row: what it is, what it must be, what it was.
#include "benchmarks/gate/figures.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eciton::bench {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Bound {
  bool at_least = false;
  double limit = 0;

  std::string text() const { return (at_least ? "≥ " : "≤ ") + number_text(limit); }
  bool holds(double value) const { return at_least ? value >= limit : value <= limit; }  // never for NaN
};

Bound bound_of(const Json& figure) {
  const bool at_least = figure.contains("at_least");
  return {at_least, figure.at(at_least ? "at_least" : "at_most").get<double>()};
}

void judge(Verdict& verdict, const std::string& name, double value, const Bound& bound) {
  const bool good = bound.holds(value);
  verdict.table.rows.push_back({name, bound.text(), number_text(value), good ? "" : "MISSED"});
  if (!good) verdict.missed.push_back(name + ": " + number_text(value) + ", where " + bound.text() + " is right");
}

/// Quickest repetition, ns of processor time; NaN: it did not run.
double time_of(const Json& results, const std::string& name) {
  double least = nan;
  for (const Json& run : results.at("benchmarks")) {
    if (run.value("run_name", "") != name || run.value("run_type", "") != "iteration") continue;
    if (run.value("time_unit", "") != "ns" || run.value("error_occurred", false)) continue;
    least = std::fmin(least, run.at("cpu_time").get<double>());
  }
  return least;
}

/// The least of them; NaN if one is missing: the best may be the one that did not run.
double best_time_of(const Json& results, const Json& names) {
  if (names.is_string()) return time_of(results, names.get<std::string>());
  double least = std::numeric_limits<double>::infinity();
  for (const Json& name : names) {
    const double time = time_of(results, name.get<std::string>());
    if (std::isnan(time)) return nan;
    least = std::min(least, time);
  }
  return least;
}

/// Json's exceptions name the member that is missing or of another type.
template <class Judge>
eciton::Result<Verdict> explained(Judge&& judge_all) {
  Verdict verdict;
  verdict.table.columns = {"", "wanted", "is", ""};
  try {
    judge_all(verdict);
  } catch (const Json::exception& wrong) {
    return Error{std::string("the figures or the results are not what the gate reads: ") + wrong.what()};
  }
  return verdict;
}

}  // namespace

eciton::Result<Verdict> judge_ratios(const Json& results, const Json& figures) {
  return explained([&](Verdict& verdict) {
    verdict.table.title = "Ratios within one run";
    for (const Json& figure : figures) {
      const double over = time_of(results, figure.at("over").get<std::string>());
      judge(verdict, figure.at("figure").get<std::string>(), best_time_of(results, figure.at("of")) / over,
            bound_of(figure));
    }
  });
}

eciton::Result<Verdict> judge_metrics(const Json& measurement, const Json& figures) {
  return explained([&](Verdict& verdict) {
    verdict.table.title = "Metrics of " + measurement.at("command").get<std::string>();
    if (measurement.at("series").value("partial", false)) {
      verdict.missed.push_back("the run was cut short or something to be measured was not there");
    }
    for (const Json& figure : figures) {
      const std::string pattern = figure.at("metrics").get<std::string>();
      const Bound bound = bound_of(figure);
      bool any = false;
      for (const auto& [name, value] : measurement.at("metrics").items()) {
        if (::fnmatch(pattern.c_str(), name.c_str(), 0) != 0) continue;
        any = true;
        judge(verdict, name, value.is_number() ? value.get<double>() : nan, bound);
      }
      if (!any) judge(verdict, pattern, nan, bound);
    }
  });
}

}  // namespace eciton::bench
