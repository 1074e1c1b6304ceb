// The page: what was measured, its tables and its charts, in one file that needs no network.
#include <utility>
#include <vector>

#include "benchmarks/report/charts.hpp"
#include "benchmarks/report/result.hpp"
#include "deploy/report/page_style.hpp"

namespace eciton::bench {
namespace {

using report::page_script;
using report::page_style;

std::string card(const std::string& title, const std::string& inside) {
  return "<div class=\"card\">" + (title.empty() ? "" : "<h3>" + escaped(title) + "</h3>\n") + inside + "</div>\n";
}

std::string row(const std::vector<std::string>& cells, const std::string& element) {
  std::string text = "<tr>";
  for (const std::string& cell : cells) text += "<" + element + ">" + escaped(cell) + "</" + element + ">";
  return text + "</tr>\n";
}

std::string table_card(const Table& table) {
  std::string text = "<div class=\"wide\"><table>\n<thead>" + row(table.columns, "th") + "</thead>\n<tbody>\n";
  for (const std::vector<std::string>& cells : table.rows) text += row(cells, "td");
  return card(table.title, text + "</tbody></table></div>\n");
}

std::string plain(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

/// Nested objects by dotted names.
void add_config(std::string& text, const std::string& name, const Json& value) {
  if (value.is_object() && !value.empty()) {
    for (const auto& [key, inner] : value.items()) add_config(text, name.empty() ? key : name + "." + key, inner);
  } else if (!name.empty()) {
    text += "<dt>" + escaped(name) + "</dt><dd>" + escaped(plain(value)) + "</dd>\n";
  }
}

/// In the order in which the charts first appear.
std::vector<std::pair<std::string, SampleSet>> charts_of(const Result& result) {
  std::vector<std::pair<std::string, SampleSet>> charts;
  for (const Samples& samples : result.samples) {
    const std::string name = samples.chart.empty() ? samples.unit : samples.chart;
    auto chart = charts.begin();
    while (chart != charts.end() && chart->first != name) ++chart;
    if (chart == charts.end()) chart = charts.insert(charts.end(), {name, {}});
    chart->second.push_back(&samples);
  }
  return charts;
}

std::string head(const Result& result) {
  std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n";
  text += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n";
  text +=
      "<title>" + escaped(result.title) + "</title>\n<style>" + page_style + "</style>\n</head>\n<body>\n<main>\n";
  text += "<h1>" + escaped(result.title) + "</h1>\n<p class=\"under\">eciton " + escaped(result.command) + ", " +
          escaped(result.clock) + " clock";
  if (!result.seed.is_null()) text += ", seed " + escaped(plain(result.seed));
  text += "</p>\n";
  if (result.partial) text += "<p class=\"partial\">partial: less was measured than was asked for</p>\n";
  return text;
}

std::string notes_of(const Result& result) {
  if (result.notes.empty()) return "";
  std::string text = "<ul>\n";
  for (const std::string& note : result.notes) text += "<li>" + escaped(note) + "</li>\n";
  return "<h2>Notes</h2>\n" + card("", text + "</ul>\n");
}

}  // namespace

std::string to_html(const Result& result) {
  std::string text = head(result);
  if (!result.bars.empty()) text += "<h2 id=\"side-by-side\">Side by side, 95 % confidence</h2>\n";
  for (const Bars& bars : result.bars) text += card(bars.title, bars_chart(bars));
  for (const Curves& curves : result.curves) text += card(curves.title, curves_chart(curves));
  if (!result.tables.empty()) text += "<h2 id=\"figures\">Figures</h2>\n";
  for (const Table& table : result.tables) text += table_card(table);
  text += notes_of(result);
  const auto charts = charts_of(result);
  if (!charts.empty()) text += "<h2 id=\"distributions\">Distributions</h2>\n";
  for (const auto& [name, samples] : charts) text += card(name, distribution_chart(samples));
  std::string over_time;
  for (const auto& [name, samples] : charts) {
    const std::string chart = time_chart(samples);
    if (!chart.empty()) over_time += card(name, chart);
  }
  if (!over_time.empty()) text += "<h2 id=\"over-time\">Over time</h2>\n" + over_time;
  std::string config;
  add_config(config, "", result.config);
  if (!config.empty()) text += "<h2>What was run</h2>\n" + card("", "<dl>\n" + config + "</dl>\n");
  return text + "</main>\n<script>" + page_script + "</script>\n</body>\n</html>\n";
}

}  // namespace eciton::bench
