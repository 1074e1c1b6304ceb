// For experiments that the papers do not plot: every series over time, together by unit.
#include <map>

#include "deploy/experiments/report/plots.hpp"
#include "deploy/experiments/report/series.hpp"

namespace eciton::deploy {
namespace {

using report::Lines;
using report::Plot;
using report::Trace;

constexpr std::size_t together_max = 6;

std::string title_case(std::string words) {
  if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 'a' + 'A');
  return words;
}

Trace trace_of(const SeriesName& name, const std::vector<double>& time_s, const std::vector<double>& values) {
  const std::string words = name.quantity + (name.qualifier.empty() ? "" : ", " + name.qualifier);
  const bool wrench = name.unit == "N" || name.unit == "Nm";
  return wrench ? filtered(words, time_s, values) : Trace{.name = words, .x = time_s, .y = values};
}

}  // namespace

std::vector<Plot> series_plots(const Figures& figures) {
  const auto& time_s = series_of(figures, "time_s");
  std::map<std::string, std::map<std::string, std::vector<Trace>>> by_unit;  // then by quantity
  std::map<std::string, std::size_t> count;
  for (const auto& [name, values] : figures.series) {
    if (name == "time_s" || values.size() != time_s.size() || values.empty()) continue;
    const SeriesName parsed = parse_series_name(name);
    by_unit[parsed.unit][parsed.quantity].push_back(trace_of(parsed, time_s, values));
    ++count[parsed.unit];
  }
  std::vector<Plot> plots;
  const auto add = [&](const std::string& name, const std::string& words, const std::string& unit,
                       std::vector<Trace> traces) {
    const bool wrench = unit == "N" || unit == "Nm";
    const std::string label = unit.empty() ? words : words + ", " + unit_text(unit);
    plots.push_back(
        {name, title_case(words),
         wrench ? "Lines: low-passed at 5 Hz; bands: the standard deviation over the entire interval." : "",
         Lines{.x_label = "time, s", .y_label = label, .traces = std::move(traces), .marks = marks_of(figures)}});
  };
  for (auto& [unit, quantities] : by_unit) {
    if (count[unit] > together_max || quantities.size() == 1) {
      for (auto& [quantity, traces] : quantities) add(quantity + "_" + unit, quantity, unit, std::move(traces));
      continue;
    }
    std::vector<Trace> all;
    std::string words;
    for (auto& [quantity, traces] : quantities) {
      words += (words.empty() ? "" : ", ") + quantity;
      for (Trace& trace : traces) all.push_back(std::move(trace));
    }
    add("all_" + unit, words, unit, std::move(all));
  }
  for (Plot& plot : plots) {
    for (char& c : plot.name) c = c == ' ' ? '_' : c;
  }
  return plots;
}

}  // namespace eciton::deploy
