// Plots as SVG. Colours and type come from a style (page_style, or the file's own), so that they are as readable
// in the dark.
#pragma once

#include <string>

#include "deploy/report/plot.hpp"

namespace eciton::report {

/// Empty text: there is nothing to show.
struct Drawing {
  double width = 0, height = 0;
  std::string svg;

  bool empty() const { return svg.empty(); }
};

Drawing draw(const Plot& plot);

/// A file of its own, with title and style.
std::string svg_file(const Plot& plot, const Drawing& drawing);

/// For the page, beside page_style.
extern const char* const plot_style;

}  // namespace eciton::report
