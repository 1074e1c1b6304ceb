// Names to words, samples to traces.
#include "deploy/experiments/report/series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "deploy/report/statistics.hpp"

namespace eciton::deploy {
namespace {

constexpr double corner_Hz = 5;
constexpr double trial_step_s = 0.02;

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    if (c == '_') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

std::string joined(std::span<const std::string> words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// Runs between values that are none are filtered each by itself.
std::vector<double> filtered_values(const std::vector<double>& time_s, const std::vector<double>& values) {
  const std::size_t n = std::min(time_s.size(), values.size());
  std::vector<double> out(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n));
  if (n < 2) return out;
  const double period_s = (time_s[n - 1] - time_s[0]) / static_cast<double>(n - 1);
  for (std::size_t begin = 0; begin < n;) {
    std::size_t end = begin;
    while (end < n && std::isfinite(values[end])) ++end;
    const auto run = report::low_passed(std::span(values).subspan(begin, end - begin), period_s, corner_Hz);
    std::copy(run.begin(), run.end(), out.begin() + static_cast<std::ptrdiff_t>(begin));
    begin = end + 1;
  }
  return out;
}

}  // namespace

SeriesName parse_series_name(const std::string& name) {
  static const std::set<std::string> units{"s",     "m",      "rad", "N",     "Nm", "kg",  "W",
                                           "V",     "A",      "Hz",  "m_s",   "ms", "us",  "m_s2",
                                           "rad_s", "rad_s2", "deg", "N_m_s", "J",  "pct", "ratio"};
  const std::vector<std::string> words = words_of(name);
  for (std::size_t i = 1; i < words.size(); ++i) {
    for (std::size_t length = std::min<std::size_t>(3, words.size() - i); length > 0; --length) {
      std::string unit = words[i];
      for (std::size_t k = 1; k < length; ++k) unit += "_" + words[i + k];
      if (!units.contains(unit)) continue;
      const std::span<const std::string> all(words);
      return {joined(all.first(i)), unit, joined(all.subspan(i + length))};
    }
  }
  return {joined(words), "", ""};
}

std::string unit_text(const std::string& unit) {
  static const std::map<std::string, std::string> texts{{"m_s", "m/s"},       {"rad_s", "rad/s"}, {"m_s2", "m/s²"},
                                                        {"rad_s2", "rad/s²"}, {"N_m_s", "Nm·s"},  {"pct", "%"},
                                                        {"us", "µs"}};
  const auto found = texts.find(unit);
  return found == texts.end() ? unit : found->second;
}

const std::vector<double>& series_of(const Figures& figures, const std::string& name) {
  static const std::vector<double> none;
  const auto found = figures.series.find(name);
  return found == figures.series.end() ? none : found->second;
}

report::Trace filtered(const std::string& name, const std::vector<double>& time_s,
                       const std::vector<double>& values) {
  report::Trace trace = filtered_thin(name, time_s, values);
  std::vector<double> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite), [](double v) { return std::isfinite(v); });
  trace.band = {report::standard_deviation(finite)};
  trace.style = report::TraceStyle::solid;
  return trace;
}

report::Trace filtered_thin(const std::string& name, const std::vector<double>& time_s,
                            const std::vector<double>& values) {
  report::Trace trace{.name = name, .x = time_s, .y = filtered_values(time_s, values)};
  trace.style = report::TraceStyle::thin;
  return trace;
}

report::Trace mean_of_trials(const std::string& name, const std::vector<double>& trial,
                             const std::vector<double>& time_s, const std::vector<double>& values) {
  std::map<long, std::vector<double>> at;
  const std::set<double> trials(trial.begin(), trial.end());
  const std::size_t n = std::min({trial.size(), time_s.size(), values.size()});
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isfinite(values[i])) at[std::lround(time_s[i] / trial_step_s)].push_back(values[i]);
  }
  report::Trace trace{.name = name, .x = {}, .y = {}};
  for (const auto& [step, here] : at) {
    if (2 * here.size() < trials.size()) continue;
    trace.x.push_back(static_cast<double>(step) * trial_step_s);
    trace.y.push_back(report::mean(here));
    trace.band.push_back(report::standard_deviation(here));
  }
  return trace;
}

std::vector<report::Mark> marks_of(const Figures& figures) {
  std::vector<report::Mark> marks;
  for (const double at : series_of(figures, "mark_s")) marks.push_back({at, "T" + std::to_string(marks.size() + 1)});
  return marks;
}

}  // namespace eciton::deploy
