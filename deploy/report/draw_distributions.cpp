// Box and violin plots: the density on both sides, the box inside, every value where they are few.
#include <algorithm>
#include <cmath>
#include <limits>

#include "deploy/report/frame.hpp"
#include "deploy/report/statistics.hpp"
#include "deploy/report/text.hpp"

namespace eciton::report {
namespace {

constexpr double plot_height = 290;
constexpr std::size_t points_max = 120;
constexpr int density_steps = 80;

struct Place {
  double middle, half_width;
};

/// Two kernels beyond the outermost values, but no further than zero where all are on one side of it.
std::pair<double, double> span_of(const std::vector<double>& values, double width) {
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  const double from = *least - 2 * width, to = *greatest + 2 * width;
  return {*least >= 0 ? std::max(from, 0.0) : from, to};
}

void draw_violin(Svg& svg, const Frame& frame, const std::vector<double>& values, const Place& place,
                 const std::string& css_class) {
  const double width = kernel_width(values);
  const auto [from, to] = span_of(values, width);
  std::vector<double> density;
  for (int i = 0; i <= density_steps; ++i) {
    density.push_back(kernel_density(values, width, std::lerp(from, to, static_cast<double>(i) / density_steps)));
  }
  const double greatest = *std::max_element(density.begin(), density.end());
  std::string right, left;
  for (int i = 0; i <= density_steps; ++i) {
    const double y = frame.y(std::lerp(from, to, static_cast<double>(i) / density_steps));
    const double half = place.half_width * density[static_cast<std::size_t>(i)] / greatest;
    right += (i == 0 ? "M" : "L") + Svg::point(place.middle + half, y);
    left = "L" + Svg::point(place.middle - half, y) + left;
  }
  svg.shape(right + left + "Z", "violin " + css_class);
}

void draw_box(Svg& svg, const Frame& frame, const std::vector<double>& values, const Place& place,
              const std::string& css_class) {
  const Box box = box_of(values);
  const double half = std::min(11.0, 0.3 * place.half_width), x = place.middle;
  svg.line(x, frame.y(box.whisker_low), x, frame.y(box.whisker_high), "whisker");
  for (const double end : {box.whisker_low, box.whisker_high}) {
    svg.line(x - half / 2, frame.y(end), x + half / 2, frame.y(end), "whisker");
  }
  svg.area(x - half, frame.y(box.upper_quartile), 2 * half, frame.y(box.lower_quartile) - frame.y(box.upper_quartile),
           "box " + css_class);
  svg.line(x - half, frame.y(box.median), x + half, frame.y(box.median), "median");
  const double y = frame.y(mean(values));
  svg.shape("M" + Svg::point(x, y - 5) + "L" + Svg::point(x + 5, y) + "L" + Svg::point(x, y + 5) + "L" +
                Svg::point(x - 5, y) + "Z",
            "mean");
}

/// Spread to both sides by their order, the same in every run.
void draw_points(Svg& svg, const Frame& frame, const std::vector<double>& values, const Place& place,
                 const std::string& css_class) {
  if (values.size() > points_max) return;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double aside = std::fmod(0.618034 * static_cast<double>(i + 1), 1.0) - 0.5;
    svg.dot(place.middle + 0.9 * place.half_width * aside, frame.y(values[i]), 2.6, "point " + css_class);
  }
}

}  // namespace

Drawing draw_distributions(const Distributions& given, const std::string& title) {
  std::vector<Distribution> columns = given.columns;
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  const auto hold = [&](double value) {
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  };
  for (Distribution& column : columns) {
    std::erase_if(column.values, [](double value) { return !std::isfinite(value); });
    if (column.values.empty()) continue;
    const auto [from, to] = span_of(column.values, kernel_width(column.values));
    hold(from);
    hold(to);
  }
  std::erase_if(columns, [](const Distribution& column) { return column.values.empty(); });
  if (columns.empty()) return {};
  for (const Level& level : given.levels) hold(level.at);
  const Frame frame{
      Axis::exactly(0, 1), Axis::with_room(least, greatest), 84, drawing_width - room_for(given.levels), 14,
      14 + plot_height};
  const double height = frame.bottom + (given.x_label.empty() ? 46 : 66);
  Svg svg(drawing_width, height, escaped(title));
  frame.draw_y(svg, given.y_label);
  svg.line(frame.left, frame.bottom, frame.right, frame.bottom, "axis");
  const double step = (frame.right - frame.left) / static_cast<double>(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Place place{frame.left + step * (static_cast<double>(i) + 0.5), std::min(0.4 * step, 90.0)};
    const std::string colour = colour_class(i);
    draw_violin(svg, frame, columns[i].values, place, colour);
    draw_points(svg, frame, columns[i].values, place, colour);
    draw_box(svg, frame, columns[i].values, place, colour);
    svg.words(place.middle, frame.bottom + 18, "middle", escaped(columns[i].name), "label");
    const std::string figures =
        "mean " + figure_text(mean(columns[i].values)) + ", n = " + grouped(std::to_string(columns[i].values.size()));
    const std::string short_figures = figure_text(mean(columns[i].values));
    svg.words(place.middle, frame.bottom + 35, "middle", width_of(figures) < step ? figures : short_figures, "tick");
  }
  if (!given.x_label.empty()) {
    svg.words((frame.left + frame.right) / 2, frame.bottom + 56, "middle", escaped(given.x_label), "tick");
  }
  frame.draw_levels(svg, given.levels);
  return {drawing_width, height, std::move(svg).finished()};
}

}  // namespace eciton::report
