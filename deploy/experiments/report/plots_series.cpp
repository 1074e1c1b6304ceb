// For experiments that the papers do not plot: every series over time, together by unit.
#include <algorithm>
#include <map>
#include <utility>

#include "deploy/experiments/report/plots.hpp"
#include "deploy/experiments/report/series.hpp"

namespace eciton::deploy {
namespace {

using report::Lines;
using report::Plot;
using report::Trace;

std::string title_case(std::string words) {
  if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 'a' + 'A');
  return words;
}

/// What may share an axis: "force" of "contact force", "position" of x, y and z.
std::string family_of(const std::string& quantity) {
  const std::size_t space = quantity.rfind(' ');
  if (quantity.size() == 1 || (quantity.size() > 1 && quantity[1] == ' ')) return "position";
  return space == std::string::npos ? quantity : quantity.substr(space + 1);
}

/// Together on one plot.
struct Group {
  std::vector<SeriesName> names;
  std::vector<const std::vector<double>*> values;
};

std::string words_of(const Group& group, const std::string& family) {
  const bool same = std::all_of(group.names.begin(), group.names.end(), [&](const SeriesName& name) {
    return name.quantity == group.names.front().quantity;
  });
  return same ? group.names.front().quantity : family;
}

std::vector<Trace> traces_of(const Group& group, const std::vector<double>& time_s) {
  std::vector<Trace> traces;
  for (std::size_t i = 0; i < group.names.size(); ++i) {
    const SeriesName& name = group.names[i];
    std::string words = name.quantity + (name.qualifier.empty() ? "" : " " + name.qualifier);
    if (group.names.size() == 1) words = name.qualifier;
    const bool wrench = name.unit == "N" || name.unit == "Nm";
    traces.push_back(wrench ? filtered(words, time_s, *group.values[i])
                            : Trace{.name = words, .x = time_s, .y = *group.values[i]});
  }
  return traces;
}

}  // namespace

std::vector<Plot> series_plots(const Figures& figures) {
  const auto& time_s = series_of(figures, "time_s");
  std::map<std::pair<std::string, std::string>, Group> groups;  // by unit and family
  for (const auto& [name, values] : figures.series) {
    if (name == "time_s" || values.size() != time_s.size() || values.empty()) continue;
    const SeriesName parsed = parse_series_name(name);
    Group& group = groups[{parsed.unit, family_of(parsed.quantity)}];
    group.names.push_back(parsed);
    group.values.push_back(&values);
  }
  std::vector<Plot> plots;
  for (const auto& [key, group] : groups) {
    const auto& [unit, family] = key;
    const std::string words = words_of(group, family);
    std::string file = words + (unit.empty() ? "" : "_" + unit);
    std::replace(file.begin(), file.end(), ' ', '_');
    const bool wrench = unit == "N" || unit == "Nm";
    plots.push_back(
        {file, title_case(words),
         wrench ? "Lines: low-passed at 5 Hz; bands: the standard deviation over the entire interval." : "",
         Lines{.x_label = "time, s",
               .y_label = unit.empty() ? words : words + ", " + unit_text(unit),
               .traces = traces_of(group, time_s),
               .marks = marks_of(figures)}});
  }
  return plots;
}

}  // namespace eciton::deploy
