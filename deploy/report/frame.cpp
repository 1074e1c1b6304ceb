// Axes, levels and legends. Lengths are in pixels of a drawing 900 wide.
#include "deploy/report/frame.hpp"

#include <algorithm>

#include "deploy/report/text.hpp"

namespace eciton::report {
namespace {

constexpr double letter = 6.4, row = 20, swatch = 26;

/// Where each entry begins; the last is the height of all.
std::vector<std::pair<double, double>> places_of(const std::vector<LegendEntry>& entries, double width) {
  std::vector<std::pair<double, double>> places;
  double x = 0, y = 0;
  for (const LegendEntry& entry : entries) {
    const double takes = swatch + width_of(entry.name) + 20;
    if (x > 0 && x + takes > width) {
      x = 0;
      y += row;
    }
    places.emplace_back(x, y);
    x += takes;
  }
  return places;
}

}  // namespace

double width_of(const std::string& words) {
  const auto letters = std::count_if(words.begin(), words.end(),
                                     [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
  return letter * static_cast<double>(letters);
}

std::string colour_class(std::size_t index) { return "c" + std::to_string(index % 8); }

void Frame::draw_x(Svg& svg, const std::string& label) const { draw_x_ticks(svg, label, x_axis.ticks()); }

void Frame::draw_x(Svg& svg, const std::string& label, long first, long last) const {
  std::vector<Tick> ticks;
  for (long i = first; i <= last; ++i) ticks.push_back({static_cast<double>(i), std::to_string(i)});
  draw_x_ticks(svg, label, ticks);
}

void Frame::draw_x_ticks(Svg& svg, const std::string& label, const std::vector<Tick>& ticks) const {
  for (const Tick& tick : ticks) {
    svg.line(x(tick.value), top, x(tick.value), bottom, "grid");
    svg.words(x(tick.value), bottom + 18, "middle", tick.label, "tick");
  }
  svg.line(left, bottom, right, bottom, "axis");
  svg.words((left + right) / 2, bottom + 38, "middle", escaped(label), "tick");
}

void Frame::draw_y(Svg& svg, const std::string& label) const {
  double widest = 0;
  for (const Tick& tick : y_axis.ticks()) {
    svg.line(left, y(tick.value), right, y(tick.value), "grid");
    svg.words(left - 8, y(tick.value) + 4, "end", tick.label, "tick");
    widest = std::max(widest, width_of(tick.label));
  }
  svg.line(left, top, left, bottom, "axis");
  svg.words_upwards(left - 22 - widest, (top + bottom) / 2, escaped(label), "tick");
}

void Frame::draw_levels(Svg& svg, const std::vector<Level>& levels) const {
  std::vector<Level> sorted = levels;
  std::sort(sorted.begin(), sorted.end(), [](const Level& a, const Level& b) { return a.at > b.at; });
  double free_from = top - 8;
  for (const Level& level : sorted) {
    const double at = y(level.at);
    svg.line(left, at, right, at, "limit");
    const double words = std::max(at + 4, free_from + 14);
    svg.words(right + 8, words, "start", escaped(level.label), "level");
    free_from = words;
  }
}

double room_for(const std::vector<Level>& levels) {
  double widest = 0;
  for (const Level& level : levels) widest = std::max(widest, width_of(level.label));
  return levels.empty() ? 16 : widest + 16;
}

double legend_height(const std::vector<LegendEntry>& entries, double width) {
  return entries.empty() ? 0 : places_of(entries, width).back().second + row + 6;
}

void draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, double left, double width) {
  const auto places = places_of(entries, width);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const double x = left + places[i].first, y = places[i].second + 12;
    if (entries[i].filled) {
      svg.area(x, y - 7, 18, 12, entries[i].css_class);
    } else {
      svg.line(x, y, x + 18, y, entries[i].css_class);
    }
    svg.words(x + swatch, y + 4, "start", escaped(entries[i].name), "label");
  }
}

}  // namespace eciton::report
