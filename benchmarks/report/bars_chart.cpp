// Bars in rows, so that their names have room. Lengths are in pixels of a drawing 900 wide.
#include <algorithm>
#include <cmath>
#include <set>

#include "benchmarks/report/charts.hpp"
#include "deploy/report/axis.hpp"
#include "deploy/report/svg.hpp"

namespace eciton::bench {
namespace {

using report::Axis;
using report::Svg;
using report::Tick;

constexpr double width = 900;

bool finite(const Interval& interval) { return std::isfinite(interval.low) && std::isfinite(interval.high); }

double greatest_of(const Bars& bars) {
  double greatest = bars.limit.value_or(0);
  for (const Bar& bar : bars.bars) {
    if (std::isfinite(bar.value.value)) greatest = std::max(greatest, bar.value.value);
    if (finite(bar.value)) greatest = std::max(greatest, bar.value.high);
  }
  return greatest;
}

/// Colours tell names apart where groups share them, else the groups.
class BarColours {
 public:
  explicit BarColours(const std::vector<Bar>& bars) {
    std::set<std::string> names;
    for (const Bar& bar : bars) by_name_ = by_name_ || !names.insert(bar.name).second;
  }
  std::string of(const Bar& bar) {
    const std::string& key = by_name_ ? bar.name : bar.group;
    const auto index = static_cast<std::size_t>(std::find(known_.begin(), known_.end(), key) - known_.begin());
    if (index == known_.size()) known_.push_back(key);
    return "c" + std::to_string(index % 8);
  }

 private:
  bool by_name_ = false;
  std::vector<std::string> known_;
};

}  // namespace

std::string bars_chart(const Bars& bars) {
  constexpr double names = 260, figures = 170, row = 24, heading = 26;
  BarColours colours(bars.bars);
  double height = 34;
  for (std::size_t i = 0; i < bars.bars.size(); ++i) {
    const bool begins = i == 0 || bars.bars[i].group != bars.bars[i - 1].group;
    height += row + (begins && !bars.bars[i].group.empty() ? heading : 0);
  }
  Svg svg(width, height, escaped(bars.title));
  const Axis axis = Axis::from_zero(greatest_of(bars));
  const auto x = [&](double value) { return names + axis.position(value) * (width - names - figures); };
  for (const Tick& tick : axis.ticks()) {
    svg.line(x(tick.value), 4, x(tick.value), height - 28, "grid");
    svg.words(x(tick.value), height - 10, "middle", tick.label, "tick");
  }
  svg.words(width, height - 10, "end", escaped(bars.unit), "tick");
  double y = 0;
  for (std::size_t i = 0; i < bars.bars.size(); ++i) {
    const Bar& bar = bars.bars[i];
    if ((i == 0 || bar.group != bars.bars[i - 1].group) && !bar.group.empty()) {
      y += heading;
      svg.words(4, y - 6, "start", escaped(bar.group), "name");
    }
    svg.words(names - 10, y + 16, "end", escaped(bar.name), "label");
    svg.words(width, y + 16, "end", interval_text(bar.value), "label figure");
    if (std::isfinite(bar.value.value)) {
      const std::string tip = escaped(bar.group + " " + bar.name) + ": " + interval_text(bar.value);
      svg.bar(names, y + 4, x(bar.value.value) - names, row - 8, "fill " + colours.of(bar), tip);
    }
    if (finite(bar.value)) {
      const double from = x(bar.value.low), to = x(bar.value.high), middle = y + row / 2;
      svg.line(from, middle, to, middle, "whisker");
      svg.line(from, middle - 4, from, middle + 4, "whisker");
      svg.line(to, middle - 4, to, middle + 4, "whisker");
    }
    y += row;
  }
  if (bars.limit) svg.line(x(*bars.limit), 0, x(*bars.limit), height - 28, "limit");
  return "<div class=\"wide\">" + std::move(svg).finished() + "</div>\n";
}

}  // namespace eciton::bench
