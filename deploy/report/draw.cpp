// Which drawing for which plot, and a drawing as a file.
#include "deploy/report/draw.hpp"

#include "deploy/report/frame.hpp"
#include "deploy/report/page_style.hpp"
#include "deploy/report/text.hpp"

namespace eciton::report {

const char* const plot_style = R"css(
.axis { stroke: var(--quiet); stroke-width: 1; }
.line.thin { stroke-width: 1.1; opacity: 0.75; }
.level { fill: var(--limit); }
.mark { stroke: var(--quiet); stroke-width: 1; stroke-dasharray: 2 3; }
.range { fill: var(--k); opacity: 0.18; stroke: none; }
.violin { fill: var(--k); opacity: 0.25; stroke: none; }
.box { fill: var(--card); stroke: var(--k); stroke-width: 1.6; fill-opacity: 0.8; }
.median { stroke: var(--ink); stroke-width: 2; }
.mean { fill: var(--ink); stroke: var(--card); stroke-width: 1; }
.point { fill: var(--k); opacity: 0.75; }
.open { fill: var(--card); stroke: var(--k); stroke-width: 2; }
.coloured { fill: none; stroke-width: 2.4; stroke-linecap: round; stroke-linejoin: round; }
.shade { stroke-width: 15; }
.reference { fill: none; stroke: var(--quiet); stroke-width: 1.4; stroke-dasharray: 5 4; }
)css";

Drawing draw(const Plot& plot) {
  if (const auto* lines = std::get_if<Lines>(&plot.what)) return draw_lines(*lines, plot.title);
  if (const auto* columns = std::get_if<Distributions>(&plot.what)) return draw_distributions(*columns, plot.title);
  return draw_path(std::get<Path>(plot.what), plot.title);
}

std::string svg_file(const Plot& plot, const Drawing& drawing) {
  constexpr double margin = 16, heading = 40;
  const double width = drawing.width + 2 * margin, height = drawing.height + heading + margin;
  const std::string size =
      "width=\"" + Svg::number(drawing.width) + "\" height=\"" + Svg::number(drawing.height) + "\"";
  std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + Svg::number(width) + "\" height=\"" +
                     Svg::number(height) + "\" viewBox=\"0 0 " + Svg::number(width) + " " + Svg::number(height) +
                     "\">\n<style>" + page_style + plot_style +
                     "svg { font-family: \"DejaVu Sans\", Verdana, sans-serif; } .paper { fill: var(--card); } "
                     "svg .heading { font-size: 15px; font-weight: 600; }\n</style>\n<rect width=\"100%\" "
                     "height=\"100%\" class=\"paper\"/>\n<text x=\"16\" y=\"26\" class=\"heading\">" +
                     escaped(plot.title) + "</text>\n";
  std::string inside = drawing.svg;
  inside.insert(4, " x=\"" + Svg::number(margin) + "\" y=\"" + Svg::number(heading) + "\" " + size);
  return text + inside + "</svg>\n";
}

}  // namespace eciton::report
