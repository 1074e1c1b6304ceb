// Values stand where the axes say, words do not stand on each other, and a file stands alone.
#include "deploy/report/draw.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <set>

#include "tests/deploy/report/well_formed.hpp"

namespace eciton::report {
namespace {

Plot line_plot(Lines lines) { return {"a", "A title", "", std::move(lines)}; }

Lines ramp() {
  Lines lines{.x_label = "time, s", .y_label = "force, N", .traces = {}};
  lines.traces.push_back({.name = "one", .x = {0, 10}, .y = {0, 100}});
  return lines;
}

/// The y of the text element that holds these words.
double height_of(const std::string& svg, const std::string& words) {
  const std::size_t element = svg.rfind("<text", svg.find(">" + words + "</text>"));
  const std::size_t at = svg.find(" y=\"", element);
  return std::atof(svg.c_str() + at + 4);
}

TEST(DrawLinesTest, EndsStandWhereTheAxesSay) {
  const std::string svg = draw(line_plot(ramp())).svg;
  const std::size_t begin = svg.find("<path d=\"M") + 10;
  double x[2], y[2];
  ASSERT_EQ(std::sscanf(svg.c_str() + begin, "%lf,%lfL%lf,%lf", &x[0], &y[0], &x[1], &y[1]), 4);
  EXPECT_NEAR(x[0], 84, 0.1);   // the left edge
  EXPECT_NEAR(x[1], 884, 0.1);  // the right edge
  // 250 pixels are 0 to 105; ticks' words stand 4 lower than their line.
  EXPECT_NEAR(y[0] - y[1], 250 * 100 / 105.0, 0.2);
  EXPECT_NEAR(height_of(svg, "100") - 4, y[1], 0.2);
}

TEST(DrawLinesTest, NamesOfMarksAndLevelsKeepApart) {
  Lines lines = ramp();
  lines.marks = {{5, "T1"}, {5.05, "T2"}, {5.1, "T3"}, {9, "T4"}};
  lines.levels = {{50, "ours"}, {50.5, "paper"}, {51, "bar"}};
  const std::string svg = draw(line_plot(lines)).svg;
  const std::set<double> rows{height_of(svg, "T1"), height_of(svg, "T2"), height_of(svg, "T3")};
  EXPECT_EQ(rows.size(), 3u);
  EXPECT_EQ(height_of(svg, "T4"), height_of(svg, "T1"));
  EXPECT_GE(height_of(svg, "paper") - height_of(svg, "bar"), 14);
  EXPECT_GE(height_of(svg, "ours") - height_of(svg, "paper"), 14);
}

TEST(DrawLinesTest, ABandIsAsHighAsTwiceItsHalf) {
  Lines lines = ramp();
  lines.traces[0].y = {50, 100};
  lines.traces[0].band = {10};
  const std::string svg = draw(line_plot(lines)).svg;
  const std::size_t begin = svg.find("<path d=\"M") + 10;
  double x[4], y[4];
  ASSERT_EQ(std::sscanf(svg.c_str() + begin, "%lf,%lfL%lf,%lfL%lf,%lfL%lf,%lf", &x[0], &y[0], &x[1], &y[1], &x[2],
                        &y[2], &x[3], &y[3]),
            8);
  EXPECT_NEAR(y[2] - y[1], 250 * 20 / (1.05 * 110), 0.2);
  EXPECT_NEAR(y[3] - y[0], 250 * 20 / (1.05 * 110), 0.2);
}

TEST(DrawLinesTest, WhatIsBeyondTheCutOffHasAnOpenMarker) {
  Lines lines{.x_label = "modules", .y_label = "s", .traces = {}, .y_logarithmic = true, .x_whole = true};
  lines.traces.push_back(
      {.name = "a", .x = {1, 2, 3}, .y = {1, 60, INFINITY}, .style = TraceStyle::points, .cut_off = 60});
  const std::string svg = draw(line_plot(lines)).svg;
  EXPECT_EQ(count_of(svg, "class=\"open c0\""), 2u);
  EXPECT_EQ(count_of(svg, "class=\"fill c0\""), 1u);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(DrawLinesTest, ALineBreaksWhereThereIsNoNumber) {
  Lines lines = ramp();
  lines.traces[0].x = {0, 1, 2, 3, 4};
  lines.traces[0].y = {1, 2, NAN, 2, 1};
  const std::string svg = draw(line_plot(lines)).svg;
  EXPECT_EQ(count_of(svg, "M"), 2u);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(DrawTest, NothingToShowIsNoDrawing) {
  EXPECT_TRUE(draw(line_plot({})).empty());
  Lines never = ramp();
  never.traces[0].y.clear();
  EXPECT_TRUE(draw(line_plot(never)).empty());
  never.traces[0] = {.name = "", .x = {NAN}, .y = {NAN}};
  EXPECT_TRUE(draw(line_plot(never)).empty());
  EXPECT_TRUE(draw({"a", "A", "", Distributions{"", "m", {{"none", {}}}}}).empty());
  EXPECT_TRUE(draw({"a", "A", "", Path{}}).empty());
}

TEST(DrawDistributionsTest, ABoxReachesFromQuartileToQuartile) {
  const Plot plot{"a", "A", "", Distributions{"", "s", {{"ours", {1, 2, 3, 4, 5}}}, {{20, "paper"}}}};
  const std::string svg = draw(plot).svg;
  const std::size_t box = svg.rfind("<rect", svg.find("class=\"box"));
  double x, y, width, height;
  ASSERT_EQ(std::sscanf(svg.c_str() + box, "<rect x=\"%lf\" y=\"%lf\" width=\"%lf\" height=\"%lf\"", &x, &y, &width,
                        &height),
            4);
  EXPECT_NEAR(height, 290 * 2 / 21.0, 0.2);  // from 2 to 4 on an axis from 0 to 21
  EXPECT_EQ(count_of(svg, "<circle"), 5u);
  EXPECT_NE(svg.find(">mean 3, n = 5<"), std::string::npos);
}

TEST(DrawPathTest, OneScaleInAllDirections) {
  Path path;
  for (int i = 0; i <= 100; ++i) {
    path.x_m.push_back(std::cos(0.0628 * i));
    path.y_m.push_back(std::sin(0.0628 * i));
    path.z_m.push_back(1.5);
    path.speed_m_s.push_back(i < 50 ? 0.2 : 0.8);
  }
  const std::string svg = draw({"a", "A", "", path}).svg;
  double least_x = 1e9, greatest_x = 0, least_y = 1e9, greatest_y = 0;
  const std::string plan = svg.substr(0, svg.find(">from the side<"));
  for (std::size_t at = plan.find("stroke=\"#"); at != std::string::npos; at = plan.find("stroke=\"#", at + 1)) {
    const char* data = plan.c_str() + plan.rfind("d=\"", at) + 3;
    double x, y;
    int length = 0;
    while (std::sscanf(data, "%*1[ML]%lf,%lf%n", &x, &y, &length) == 2) {
      least_x = std::min(least_x, x);
      greatest_x = std::max(greatest_x, x);
      least_y = std::min(least_y, y);
      greatest_y = std::max(greatest_y, y);
      data += length;
    }
  }
  EXPECT_GT(greatest_x - least_x, 200);
  EXPECT_NEAR(greatest_x - least_x, greatest_y - least_y, 1.5);  // a circle
}

TEST(SvgFileTest, StandsAlone) {
  Lines lines = ramp();
  lines.traces[0].name = lines.y_label = "</svg>&\"'<";
  lines.marks = {{5, "<T1>"}};
  lines.levels = {{50, "a & b"}};
  lines.ranges = {{1, 2, 3, 4, "<range>"}};
  const Plot plot{"a", "A & <b>", "", lines};
  const std::string file = svg_file(plot, draw(plot));
  EXPECT_TRUE(well_formed(file));
  EXPECT_NE(file.find("<style>"), std::string::npos);
  EXPECT_EQ(count_of(file, "//"), 1u);  // the name of SVG itself
  std::string broken = file;
  broken.replace(broken.find("</svg>"), 6, "");
  EXPECT_FALSE(well_formed(broken));
}

}  // namespace
}  // namespace eciton::report
