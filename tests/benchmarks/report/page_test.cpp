// The page stands alone and is well formed, whatever the names in it; its pictures are where the figures say.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>

#include "benchmarks/report/charts.hpp"
#include "benchmarks/report/result.hpp"
#include "tests/benchmarks/report/made_up_result.hpp"

namespace eciton::bench {
namespace {

/// The page is written so that it is XML too; an XML parser forgives nothing.
bool well_formed(const std::string& text) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("eciton_page_" + std::to_string(::getpid()) + ".html")).string();
  std::ofstream(file) << text;
  const int status = std::system((ECITON_XMLLINT " --noout --nonet '" + file + "' 2>/dev/null").c_str());
  std::filesystem::remove(file);
  return status == 0;
}

std::vector<std::string> references(const std::string& text) {
  static const std::regex reference(R"((\b(src|href|srcset|action|data|poster)\s*=)|url\(|@import|//[a-z]|fetch\()");
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), reference), end; it != end; ++it) found.push_back(it->str());
  return found;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(PageTest, IsWellFormedWhateverTheNames) {
  EXPECT_TRUE(well_formed(to_html(made_up_result())));
  Result hostile = made_up_result();
  hostile.title = hostile.samples[0].name = hostile.samples[1].chart = "</script><b>&amp \"'\x01\n]]>";
  hostile.bars[0].bars[0].group = hostile.tables[0].rows[0][0] = hostile.title;
  hostile.notes = {hostile.title};
  hostile.config[hostile.title] = hostile.title;
  EXPECT_TRUE(well_formed(to_html(hostile)));
  EXPECT_EQ(count_of(to_html(hostile), "<script>"), 1u);
}

TEST(PageTest, TheParserWouldHaveSaidSo) {
  std::string text = to_html(made_up_result());
  text.replace(text.find("</svg>"), 6, "");
  EXPECT_FALSE(well_formed(text));
}

TEST(PageTest, RefersToNothingOutside) {
  EXPECT_EQ(references(to_html(made_up_result())), std::vector<std::string>{});
  EXPECT_EQ(references("<img src=\"https://a.b/c\"/>").size(), 2u);
}

TEST(PageTest, ShowsEachThingThatWasMeasured) {
  const std::string page = to_html(made_up_result());
  EXPECT_EQ(count_of(page, "<svg"), 2u + 2 + 2);  // bars, curves; a distribution and a time series for each size
  EXPECT_EQ(count_of(page, "<table>"), 1u);
  EXPECT_NE(page.find("link.delay_ms</dt><dd>0<"), std::string::npos);
  EXPECT_NE(page.find("LCM is not installed"), std::string::npos);
  EXPECT_NE(page.find("class=\"partial\""), std::string::npos);
  EXPECT_NE(page.find("Fast DDS, ours (partial)"), std::string::npos);
  EXPECT_NE(page.find(">3 lost<"), std::string::npos);
}

TEST(PageTest, HoldsWithNothingMeasured) {
  Result nothing;
  nothing.title = "Latency";
  EXPECT_TRUE(well_formed(to_html(nothing)));
  nothing.samples.push_back({.name = "never came", .unit = "µs", .sent = 5, .lost = 5});
  nothing.bars.push_back({"nothing", "ratio", {{"", "never came", {NAN, NAN, NAN}}}, {}});
  nothing.tables.push_back(summary_table("", nothing.samples));
  const std::string page = to_html(nothing);
  EXPECT_TRUE(well_formed(page));
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_EQ(page.find("inf"), std::string::npos);
}

TEST(DistributionChartTest, ALineEndsWhereItsCountResolvesNoMore) {
  Samples hundred{.name = "a", .unit = "µs"};
  for (int i = 101; i <= 200; ++i) hundred.values.push_back(i);
  const std::string chart = distribution_chart({&hundred});
  const std::size_t begin = chart.find("<path d=\"") + 9;
  const std::string data = chart.substr(begin, chart.find('"', begin) - begin);
  // Two nines of four: in the middle of 70 to 880; 199 on an axis from 0 to 210, drawn from 350 up to 20.
  EXPECT_EQ(data.substr(data.rfind('L')), "L475.0,37.3");
  EXPECT_EQ(data.substr(0, 11), "M70.0,191.3");  // 101, the least
}

TEST(TimeChartTest, ALineBreaksWhereNothingWasMeasuredForLong) {
  Samples steady{.name = "a", .unit = "µs"};
  for (int i = 0; i <= 300; ++i) {
    steady.at_s.push_back(i);
    steady.values.push_back(5);
  }
  Samples turns = steady;
  for (int i = 100; i < 200; ++i) turns.at_s[static_cast<std::size_t>(i)] = 250 + 0.1 * i;
  const auto begins = [](const Samples& samples) { return count_of(time_chart({&samples}), "M"); };
  EXPECT_EQ(begins(steady), 2u);  // band and median
  EXPECT_EQ(begins(turns), 4u);
  steady.at_s.clear();
  EXPECT_EQ(time_chart({&steady}), "");
}

TEST(CurvesChartTest, PowersAreStraightLines) {
  Curves curves{"", "N", "ns", {{"cubic"}}};
  for (const double n : {1., 10., 100.}) curves.curves[0].points.emplace_back(n, n * n * n);
  const std::string chart = curves_chart(curves);
  const std::size_t begin = chart.find("<path d=\"M") + 10;
  double x[3], y[3];
  ASSERT_EQ(std::sscanf(chart.c_str() + begin, "%lf,%lfL%lf,%lfL%lf,%lf", &x[0], &y[0], &x[1], &y[1], &x[2], &y[2]),
            6);
  EXPECT_NEAR(x[1] - x[0], x[2] - x[1], 0.2);
  EXPECT_NEAR(y[1] - y[0], y[2] - y[1], 0.2);
  EXPECT_LT(y[2], y[0]);
  EXPECT_EQ(curves_chart({"", "N", "ns", {{"nothing"}}}), "");
}

TEST(BarsChartTest, WhiskersStandAtTheirValues) {
  const std::string chart = bars_chart({"", "ratio", {{"", "a", {1, 2, 4}}}, 3});
  // From 260 to 730 pixels is 0 to 4.2.
  EXPECT_NE(chart.find("<rect x=\"260.0\" y=\"4.0\" width=\"223.8\""), std::string::npos) << chart;
  EXPECT_NE(chart.find("<line x1=\"371.9\" y1=\"12.0\" x2=\"707.6\" y2=\"12.0\" class=\"whisker\"/>"),
            std::string::npos);
  EXPECT_NE(chart.find("<line x1=\"595.7\" y1=\"0.0\" x2=\"595.7\""), std::string::npos);
  const std::string unknown = bars_chart({"", "ratio", {{"", "a", {-INFINITY, 2, INFINITY}}}, {}});
  EXPECT_EQ(count_of(unknown, "class=\"whisker\""), 0u);
}

}  // namespace
}  // namespace eciton::bench
