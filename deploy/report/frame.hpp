// A rectangle of a drawing with an axis each way, and what every kind of plot draws on it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "deploy/report/axis.hpp"
#include "deploy/report/draw.hpp"
#include "deploy/report/svg.hpp"

namespace eciton::report {

inline constexpr double drawing_width = 900;

/// Roughly, in the style's type: enough to keep words apart.
double width_of(const std::string& words);

/// Colours are told apart up to eight.
std::string colour_class(std::size_t index);

struct Frame {
  Axis x_axis, y_axis;
  double left, right, top, bottom;

  double x(double value) const { return left + x_axis.position(value) * (right - left); }
  double y(double value) const { return bottom - y_axis.position(value) * (bottom - top); }
  std::string point(double at_x, double at_y) const { return Svg::point(x(at_x), y(at_y)); }

  void draw_x(Svg& svg, const std::string& label) const;
  /// Every whole number from `first` to `last` instead of round ones.
  void draw_x(Svg& svg, const std::string& label, long first, long last) const;
  void draw_y(Svg& svg, const std::string& label) const;
  /// Dashed lines at their heights, named to the right of the frame, no name over another.
  void draw_levels(Svg& svg, const std::vector<Level>& levels) const;

 private:
  void draw_x_ticks(Svg& svg, const std::string& label, const std::vector<Tick>& ticks) const;
};

/// What the names of the levels take to the right of the frame.
double room_for(const std::vector<Level>& levels);

/// Names with their signs, in rows across the top. Returns the height that they take.
struct LegendEntry {
  std::string name, css_class;
  bool filled = false;
};
double legend_height(const std::vector<LegendEntry>& entries, double width);
void draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, double left, double width);

Drawing draw_lines(const Lines& lines, const std::string& title);
Drawing draw_distributions(const Distributions& distributions, const std::string& title);
Drawing draw_path(const Path& path, const std::string& title);

}  // namespace eciton::report
