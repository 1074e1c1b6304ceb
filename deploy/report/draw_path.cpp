// A flight in plan and from the side, on one scale, coloured by speed.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <span>

#include "deploy/report/frame.hpp"
#include "deploy/report/text.hpp"

namespace eciton::report {
namespace {

constexpr std::size_t shades = 32, points_max = 3000;
constexpr double panel_width = 350, panel_height_max = 420, panel_height_min = 130;

/// Viridis, without its darkest and its lightest end: readable on white and on black.
std::string shade(double fraction) {
  constexpr std::array<std::array<double, 3>, 6> stops{
      {{72, 70, 150}, {52, 100, 150}, {33, 145, 140}, {53, 183, 121}, {140, 208, 60}, {224, 205, 30}}};
  const double at = std::clamp(fraction, 0.0, 1.0) * (stops.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  char text[8];
  const auto channel = [&](std::size_t c) {
    return static_cast<unsigned>(
        std::lround(std::lerp(stops[below][c], stops[below + 1][c], at - static_cast<double>(below))));
  };
  std::snprintf(text, sizeof text, "#%02x%02x%02x", channel(0) & 255u, channel(1) & 255u, channel(2) & 255u);
  return text;
}

struct Extent {
  double least = std::numeric_limits<double>::infinity(), greatest = -least;

  void add(std::span<const double> values) {
    for (const double value : values) {
      if (!std::isfinite(value)) continue;
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    }
  }
  double size() const { return std::max(greatest - least, 0.2); }
  double middle() const { return 0.5 * (least + greatest); }
  Axis axis(double held) const { return Axis::exactly(middle() - held / 2, middle() + held / 2); }
};

/// Runs of one shade each; every run begins where the last one ended.
void draw_coloured(Svg& svg, const Frame& frame, std::span<const double> x, std::span<const double> y,
                   std::span<const double> speed, double speed_max) {
  const std::size_t n = std::min({x.size(), y.size(), speed.size()});
  const std::size_t stride = 1 + n / points_max;
  std::string data;
  std::size_t last = shades;
  for (std::size_t i = 0; i < n; i += stride) {
    const double place = std::clamp(speed[i] / speed_max, 0.0, 1.0) * (shades - 1);
    const auto now = static_cast<std::size_t>(std::lround(place));
    const std::string point = frame.point(x[i], y[i]);
    data += (data.empty() ? "M" : "L") + point;
    if (now == last && i + stride < n) continue;
    if (last < shades) svg.stroke(data, shade(static_cast<double>(last) / (shades - 1)), "coloured");
    data = "M" + point;
    last = now;
  }
}

void draw_reference(Svg& svg, const Frame& frame, std::span<const double> x, std::span<const double> y) {
  const std::size_t n = std::min(x.size(), y.size());
  std::string data;
  for (std::size_t i = 0; i < n; i += 1 + n / 1500) data += (data.empty() ? "M" : "L") + frame.point(x[i], y[i]);
  if (!data.empty()) svg.path(data, "reference", "reference");
}

void draw_colour_bar(Svg& svg, double x, double top, double bottom, double speed_max) {
  const Axis axis = Axis::exactly(0, speed_max);
  const double step = (bottom - top) / shades;
  for (std::size_t i = 0; i < shades; ++i) {
    const double y = bottom - step * (static_cast<double>(i) + 0.5);
    svg.stroke("M" + Svg::point(x, y) + "L" + Svg::point(x + 14, y), shade(static_cast<double>(i) / (shades - 1)),
               "shade");
  }
  for (const Tick& tick : axis.ticks()) {
    svg.words(x + 20, bottom - axis.position(tick.value) * (bottom - top) + 4, "start", tick.label, "tick");
  }
  svg.words(x + 14, top - 10, "middle", "speed, m/s", "tick");
}

}  // namespace

Drawing draw_path(const Path& path, const std::string& title) {
  const std::size_t n = std::min({path.x_m.size(), path.y_m.size(), path.speed_m_s.size()});
  if (n < 2) return {};
  Extent x, y, z, speed;
  x.add(path.x_m);
  x.add(path.x_reference_m);
  y.add(path.y_m);
  y.add(path.y_reference_m);
  z.add(path.z_m);
  z.add(path.z_reference_m);
  speed.add(path.speed_m_s);
  const bool side = path.z_m.size() >= 2;
  // One scale for both panels and both directions, and some room around the path.
  const double tallest_m = 1.12 * std::max(y.size(), side ? z.size() : 0.0);
  const double m_per_pixel = std::max(1.12 * x.size() / panel_width, tallest_m / panel_height_max);
  const double panel_height = std::max(tallest_m / m_per_pixel, panel_height_min);
  const std::vector<LegendEntry> entries{{"reference", "reference"}};
  const double top = 50, bottom = top + panel_height, left = 70;
  Svg svg(drawing_width, bottom + 46, escaped(title));
  if (!path.x_reference_m.empty()) draw_legend(svg, entries, left, panel_width);
  const Frame plan{
      x.axis(panel_width * m_per_pixel), y.axis(panel_height * m_per_pixel), left, left + panel_width, top, bottom};
  const double speed_max = std::max(speed.greatest, 1e-3);
  const auto draw_panel = [&](const Frame& frame, const char* name, const char* up, const std::vector<double>& height,
                              const std::vector<double>& reference) {
    frame.draw_x(svg, "x, m");
    frame.draw_y(svg, up);
    svg.words(frame.left, top - 10, "start", name, "name");
    draw_reference(svg, frame, path.x_reference_m, reference);
    draw_coloured(svg, frame, path.x_m, height, path.speed_m_s, speed_max);
  };
  draw_panel(plan, "plan", "y, m", path.y_m, path.y_reference_m);
  if (side) {
    Frame from_side = plan;
    from_side.y_axis = z.axis(panel_height * m_per_pixel);
    from_side.left = drawing_width - 60 - panel_width;
    from_side.right = drawing_width - 60;
    draw_panel(from_side, "from the side", "z, m", path.z_m, path.z_reference_m);
  }
  const double bar = side ? drawing_width - 46 : left + panel_width + 24;
  draw_colour_bar(svg, bar, top, bottom, speed_max);
  return {drawing_width, bottom + 46, std::move(svg).finished()};
}

}  // namespace eciton::report
