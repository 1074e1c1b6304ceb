// Lines over time or over a count, with bands, marks, levels and tolerances.
#include <algorithm>
#include <cmath>
#include <limits>

#include "deploy/report/frame.hpp"
#include "deploy/report/statistics.hpp"
#include "deploy/report/text.hpp"

namespace eciton::report {
namespace {

constexpr double plot_height = 250, mark_row = 16;
constexpr std::size_t columns = 450;  // of a line; wider than that none is drawn

struct Extent {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();

  void add(double value) {
    if (!std::isfinite(value)) return;
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  bool empty() const { return least > greatest; }
};

std::size_t size_of(const Trace& trace) { return std::min(trace.x.size(), trace.y.size()); }

double band_at(const Trace& trace, std::size_t i) {
  if (trace.band.empty()) return 0;
  return trace.band.size() == 1 ? trace.band.front() : trace.band[std::min(i, trace.band.size() - 1)];
}

double shown(const Trace& trace, std::size_t i) {
  return trace.cut_off > 0 && !(trace.y[i] < trace.cut_off) ? trace.cut_off : trace.y[i];
}

Axis y_axis_of(const Lines& lines) {
  Extent extent, positive;
  const auto add = [&](double value) {
    extent.add(value);
    if (value > 0) positive.add(value);
  };
  for (const Trace& trace : lines.traces) {
    for (std::size_t i = 0; i < size_of(trace); ++i) {
      add(shown(trace, i) - band_at(trace, i));
      add(shown(trace, i) + band_at(trace, i));
    }
  }
  for (const Level& level : lines.levels) add(level.at);
  for (const Range& range : lines.ranges) {
    add(range.y_from);
    add(range.y_to);
  }
  if (lines.y_logarithmic && !positive.empty())
    return Axis::of_logarithms(positive.least / 1.3, positive.greatest * 1.3);
  return Axis::with_room(extent.empty() ? 0 : extent.least, extent.empty() ? 1 : extent.greatest);
}

/// The traces' own; a tolerance beyond them is cut.
Extent x_extent_of(const Lines& lines) {
  Extent extent;
  for (const Trace& trace : lines.traces) {
    for (std::size_t i = 0; i < size_of(trace); ++i) extent.add(trace.x[i]);
  }
  return extent;
}

std::string css_of(const Trace& trace) {
  switch (trace.style) {
    case TraceStyle::solid:
    case TraceStyle::points:
      return "line";
    case TraceStyle::thin:
      return "line thin";
    case TraceStyle::dashed:
      return "line dashed";
  }
  return "line";
}

/// Breaks where a value is no number.
void draw_trace(Svg& svg, const Frame& frame, const Trace& trace, const std::string& colour) {
  const std::size_t n = size_of(trace);
  const std::vector<std::size_t> kept = thinned(std::span(trace.x).first(n), std::span(trace.y).first(n), columns);
  std::string line, above, below;
  bool broken = true;
  for (const std::size_t i : kept) {
    const double x = trace.x[i], y = shown(trace, i), half = band_at(trace, i);
    if (!std::isfinite(x) || !std::isfinite(y)) {
      broken = true;
      continue;
    }
    line += (broken ? "M" : "L") + frame.point(x, y);
    broken = false;
    above += (above.empty() ? "M" : "L") + frame.point(x, y + half);
    below = "L" + frame.point(x, y - half) + below;
  }
  if (!trace.band.empty() && !above.empty()) svg.shape(above + below + "Z", "band " + colour);
  svg.path(line, css_of(trace) + " " + colour, escaped(trace.name));
  if (trace.style != TraceStyle::points) return;
  for (const std::size_t i : kept) {
    if (!std::isfinite(trace.x[i]) || std::isnan(trace.y[i])) continue;
    const bool open = trace.cut_off > 0 && trace.y[i] >= trace.cut_off;
    svg.dot(frame.x(trace.x[i]), frame.y(shown(trace, i)), open ? 5 : 4, (open ? "open " : "fill ") + colour);
  }
}

/// In which row above the frame each mark is named, so that no name is over another.
std::vector<int> rows_of(const std::vector<Mark>& marks, const Frame& frame) {
  std::vector<int> rows;
  std::vector<double> ends;
  for (const Mark& mark : marks) {
    const double half = 0.5 * width_of(mark.label) + 4, at = frame.x(mark.at);
    std::size_t chosen = 0;
    while (chosen < ends.size() && ends[chosen] > at - half) ++chosen;
    if (chosen == ends.size()) ends.push_back(0);
    ends[chosen] = at + half;
    rows.push_back(static_cast<int>(chosen));
  }
  return rows;
}

void draw_marks(Svg& svg, const Frame& frame, const std::vector<Mark>& marks, const std::vector<int>& rows) {
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double x = frame.x(marks[i].at), y = frame.top - 6 - mark_row * rows[i];
    svg.line(x, y + 3, x, frame.bottom, "mark");
    svg.words(x, y, "middle", escaped(marks[i].label), "label");
  }
}

std::vector<LegendEntry> legend_of(const Lines& lines, const std::vector<std::string>& colours) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < lines.traces.size(); ++i) {
    const Trace& trace = lines.traces[i];
    if (!trace.name.empty()) entries.push_back({trace.name, css_of(trace) + " " + colours[i]});
  }
  for (std::size_t i = 0; i < lines.ranges.size(); ++i) {
    if (lines.ranges[i].label.empty()) continue;
    entries.push_back({lines.ranges[i].label, i % 2 == 0 ? "range c7" : "range c2", true});
  }
  return entries;
}

}  // namespace

Drawing draw_lines(const Lines& given, const std::string& title) {
  Lines lines = given;
  std::erase_if(lines.traces, [](const Trace& trace) { return size_of(trace) == 0; });
  std::sort(lines.marks.begin(), lines.marks.end(), [](const Mark& a, const Mark& b) { return a.at < b.at; });
  if (lines.traces.empty() || x_extent_of(lines).empty()) return {};
  std::vector<std::string> colours;
  std::size_t next = 0;
  for (const Trace& trace : lines.traces) {
    colours.push_back(colour_class(trace.colour < 0 ? next++ : static_cast<std::size_t>(trace.colour)));
  }
  const double left = 84;
  const Extent x = x_extent_of(lines);
  const double aside = lines.x_whole ? 0.5 : 0;
  Frame frame{Axis::exactly(x.least - aside, x.greatest + aside),
              y_axis_of(lines),
              left,
              drawing_width - room_for(lines.levels),
              0,
              0};
  std::erase_if(lines.marks, [&](const Mark& mark) { return !std::isfinite(mark.at); });
  const std::vector<LegendEntry> entries = legend_of(lines, colours);
  const std::vector<int> rows = rows_of(lines.marks, frame);
  const int mark_rows = rows.empty() ? 0 : 1 + *std::max_element(rows.begin(), rows.end());
  frame.top = 10 + legend_height(entries, drawing_width - left) + mark_row * mark_rows;
  frame.bottom = frame.top + plot_height;
  Svg svg(drawing_width, frame.bottom + 46, escaped(title));
  draw_legend(svg, entries, left, drawing_width - left);
  for (std::size_t i = 0; i < lines.ranges.size(); ++i) {
    const Range& range = lines.ranges[i];
    const double from = frame.x(range.x_from), top = frame.y(range.y_to);
    svg.area(from, top, frame.x(range.x_to) - from, frame.y(range.y_from) - top,
             i % 2 == 0 ? "range c7" : "range c2");
  }
  if (lines.x_whole) {
    frame.draw_x(svg, lines.x_label, std::lround(x.least), std::lround(x.greatest));
  } else {
    frame.draw_x(svg, lines.x_label);
  }
  frame.draw_y(svg, lines.y_label);
  draw_marks(svg, frame, lines.marks, rows);
  for (std::size_t i = 0; i < lines.traces.size(); ++i) draw_trace(svg, frame, lines.traces[i], colours[i]);
  frame.draw_levels(svg, lines.levels);
  return {drawing_width, frame.bottom + 46, std::move(svg).finished()};
}

}  // namespace eciton::report
