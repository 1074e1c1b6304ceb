// Charts with lines. Lengths are in pixels of a drawing 900 wide.
#include "benchmarks/report/charts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "benchmarks/statistics/summary.hpp"
#include "deploy/report/axis.hpp"
#include "deploy/report/svg.hpp"

namespace eciton::bench {
namespace {

using report::Axis;
using report::Svg;
using report::Tick;

constexpr double width = 900, left = 70, right = 20;
constexpr double infinity = std::numeric_limits<double>::infinity();

std::string colour(std::size_t index) { return "c" + std::to_string(index % 8); }
/// More than eight lines: the ninth is the first one's colour, dashed.
std::string line_class(std::size_t index) { return "line " + colour(index) + (index % 16 >= 8 ? " dashed" : ""); }

/// A rectangle of the drawing with an axis each way.
struct Frame {
  Axis x_axis, y_axis;
  double top, bottom;

  double x(double value) const { return left + x_axis.position(value) * (width - left - right); }
  double y(double value) const { return bottom - y_axis.position(value) * (bottom - top); }

  void draw_y(Svg& svg) const {
    for (const Tick& tick : y_axis.ticks()) {
      svg.line(left, y(tick.value), width - right, y(tick.value), "grid");
      svg.words(left - 8, y(tick.value) + 4, "end", tick.label, "tick");
    }
  }
};

Axis value_axis(const SampleSet& samples) {
  double least = infinity, greatest = -infinity;
  for (const Samples* one : samples) {
    for (const double value : one->values) {
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    }
  }
  return std::isfinite(least) ? Axis::around(least, greatest) : Axis::exactly(0, 1);
}

std::string tip_of(const Samples& one) {
  const Summary s = summarize(one);
  return escaped(one.name) + ": p50 " + number_text(s.p50) + ", p99 " + number_text(s.p99) + ", max " +
         number_text(s.max) + " " + escaped(one.unit);
}

std::string legend(const SampleSet& samples) {
  std::string text = "<div class=\"legend\">";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Samples& one = *samples[i];
    text += "<span data-line=\"" + std::to_string(i) + "\"><i class=\"" + colour(i) + (i % 16 >= 8 ? " dashed" : "") +
            "\"></i>" + escaped(one.name) + (one.partial ? " (partial)" : "");
    if (one.lost > 0) text += " <small>" + std::to_string(one.lost) + " lost</small>";
    text += "</span>\n";
  }
  return text + "</div>\n";
}

/// Nines: 0 at p0, 1 at p90, 4 at p99.99.
double nines(double fraction) { return -std::log10(1 - fraction); }

std::string quantile_line(const Samples& one, const Frame& frame) {
  std::vector<double> sorted = one.values;
  std::sort(sorted.begin(), sorted.end());
  const double last = std::min(4.0, std::log10(static_cast<double>(sorted.size())));
  constexpr int points = 400;
  std::string data;
  for (int i = 0; i <= points; ++i) {
    const double at = last * i / points;
    const double value = quantile_of_sorted(sorted, 1 - std::pow(10, -at));
    data += (i == 0 ? "M" : "L") + Svg::point(frame.x(at), frame.y(value));
  }
  return data;
}

struct Stretch {
  double at_s, least, middle, greatest;
};

std::vector<Stretch> stretches(const Samples& one, double end_s) {
  constexpr std::size_t columns = 300;
  std::vector<std::vector<double>> values(columns);
  for (std::size_t i = 0; i < std::min(one.at_s.size(), one.values.size()); ++i) {
    const double place = std::clamp(one.at_s[i] / end_s, 0.0, 1.0) * columns;
    values[std::min(static_cast<std::size_t>(place), columns - 1)].push_back(one.values[i]);
  }
  std::vector<Stretch> out;
  for (std::size_t column = 0; column < columns; ++column) {
    if (values[column].empty()) continue;
    std::sort(values[column].begin(), values[column].end());
    out.push_back({(static_cast<double>(column) + 0.5) * end_s / columns, values[column].front(),
                   quantile_of_sorted(values[column], 0.5), values[column].back()});
  }
  return out;
}

/// Where a run of stretches ends: after it comes a gap longer than three of the usual ones.
std::vector<std::span<const Stretch>> without_gaps(const std::vector<Stretch>& all) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < all.size(); ++i) gaps.push_back(all[i].at_s - all[i - 1].at_s);
  const double longest = 3.5 * quantile(gaps, 0.5);
  std::vector<std::span<const Stretch>> runs;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= all.size(); ++i) {
    if (i < all.size() && !(gaps[i - 1] > longest)) continue;
    runs.push_back(std::span(all).subspan(begin, i - begin));
    begin = i;
  }
  return runs;
}

void draw_panel(Svg& svg, const Samples& one, std::size_t index, const Frame& frame, double end_s) {
  frame.draw_y(svg);
  svg.words(left, frame.top - 8, "start", escaped(one.name), "name");
  const std::vector<Stretch> all = stretches(one, end_s);
  if (all.empty()) return;
  std::string band, middle;
  for (const std::span<const Stretch> run : without_gaps(all)) {
    std::string back;
    for (std::size_t i = 0; i < run.size(); ++i) {
      const Stretch &here = run[i], &there = run[run.size() - 1 - i];
      const char* begin = i == 0 ? "M" : "L";
      band += begin + Svg::point(frame.x(here.at_s), frame.y(here.greatest));
      back += "L" + Svg::point(frame.x(there.at_s), frame.y(there.least));
      middle += begin + Svg::point(frame.x(here.at_s), frame.y(here.middle));
    }
    band += back + "Z";
  }
  svg.path(band, "band " + colour(index), tip_of(one));
  svg.path(middle, "line " + colour(index), tip_of(one));
}

}  // namespace

std::string distribution_chart(const SampleSet& samples) {
  Svg svg(width, 400, "distribution");
  const Frame frame{Axis::exactly(0, 4), value_axis(samples), 20, 350};
  frame.draw_y(svg);
  for (const auto& [label, fraction] : std::initializer_list<std::pair<const char*, double>>{
           {"least", 0}, {"p50", 0.5}, {"p90", 0.9}, {"p99", 0.99}, {"p99.9", 0.999}, {"p99.99", 0.9999}}) {
    const double x = frame.x(nines(fraction));
    svg.line(x, frame.top, x, frame.bottom, "grid");
    svg.words(x, frame.bottom + 20, "middle", label, "tick");
  }
  if (!samples.empty()) svg.words(8, 12, "start", escaped(samples[0]->unit), "tick");
  svg.words((left + width - right) / 2, 394, "middle", "percentile, logarithmic tail", "tick");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i]->values.empty()) continue;
    svg.path(quantile_line(*samples[i], frame), line_class(i) + " s" + std::to_string(i), tip_of(*samples[i]));
  }
  return legend(samples) + "<div class=\"wide\">" + std::move(svg).finished() + "</div>\n";
}

std::string time_chart(const SampleSet& given) {
  SampleSet samples;
  double end_s = 0;
  for (const Samples* one : given) {
    if (one->at_s.empty()) continue;
    samples.push_back(one);
    end_s = std::max(end_s, *std::max_element(one->at_s.begin(), one->at_s.end()));
  }
  if (samples.empty() || end_s <= 0) return "";
  constexpr double panel = 130;
  const double height = panel * static_cast<double>(samples.size()) + 45;
  Svg svg(width, height, "time series");
  Frame frame{Axis::exactly(0, end_s), value_axis(samples), 0, 0};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    frame.top = panel * static_cast<double>(i) + 28;
    frame.bottom = frame.top + panel - 40;
    draw_panel(svg, *samples[i], i, frame, end_s);
  }
  for (const Tick& tick : frame.x_axis.ticks()) {
    svg.words(frame.x(tick.value), frame.bottom + 20, "middle", tick.label, "tick");
  }
  svg.words(8, 12, "start", escaped(samples[0]->unit), "tick");
  svg.words((left + width - right) / 2, height - 6, "middle",
            "time, s: the median of each stretch, and its least and greatest value", "tick");
  return "<div class=\"wide\">" + std::move(svg).finished() + "</div>\n";
}

std::string curves_chart(const Curves& curves) {
  double x_least = infinity, x_greatest = -infinity, y_least = infinity, y_greatest = -infinity;
  SampleSet names;
  std::vector<Samples> named(curves.curves.size());
  for (std::size_t i = 0; i < curves.curves.size(); ++i) {
    named[i].name = curves.curves[i].name;
    names.push_back(&named[i]);
    for (const auto& [x, y] : curves.curves[i].points) {
      x_least = std::min(x_least, x), x_greatest = std::max(x_greatest, x);
      y_least = std::min(y_least, y), y_greatest = std::max(y_greatest, y);
    }
  }
  if (!std::isfinite(x_least) || !std::isfinite(y_least)) return "";
  Svg svg(width, 400, escaped(curves.title));
  const Frame frame{Axis::around(x_least, x_greatest), Axis::around(y_least, y_greatest), 20, 350};
  frame.draw_y(svg);
  for (const Tick& tick : frame.x_axis.ticks()) {
    svg.words(frame.x(tick.value), frame.bottom + 20, "middle", tick.label, "tick");
  }
  svg.words(8, 12, "start", escaped(curves.unit), "tick");
  svg.words((left + width - right) / 2, 394, "middle", escaped(curves.x_name), "tick");
  for (std::size_t i = 0; i < curves.curves.size(); ++i) {
    std::string data;
    for (const auto& [x, y] : curves.curves[i].points) {
      data += (data.empty() ? "M" : "L") + Svg::point(frame.x(x), frame.y(y));
    }
    svg.path(data, line_class(i) + " s" + std::to_string(i), escaped(curves.curves[i].name));
  }
  return legend(names) + "<div class=\"wide\">" + std::move(svg).finished() + "</div>\n";
}

}  // namespace eciton::bench
