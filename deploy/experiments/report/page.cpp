// The page: figures beside the paper's, the paper's plots, stills of the flight, what was run.
#include <cstdio>

#include "deploy/experiments/report/report.hpp"
#include "deploy/report/draw.hpp"
#include "deploy/report/page_style.hpp"
#include "deploy/report/png.hpp"
#include "deploy/report/text.hpp"

namespace eciton::deploy {
namespace {

using report::escaped;

constexpr const char* own_style = R"css(
code { font: 13px/1.5 ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace; overflow-wrap: anywhere; }
.note { color: var(--quiet); font-size: 13px; margin: 6px 0 0; }
h3 { font-size: 15px; margin: 0 0 8px; }
td.met { color: var(--k2); font-weight: 600; } td.missed { color: var(--limit); font-weight: 600; }
.stills { display: grid; grid-template-columns: repeat(auto-fit, minmax(420px, 1fr)); gap: 16px; }
figure { margin: 0; background: var(--card); border: 1px solid var(--rule); border-radius: 10px; overflow: hidden; }
figure img { display: block; width: 100%; height: auto; }
figcaption { padding: 8px 14px; font-size: 13.5px; } figcaption span { color: var(--quiet); }
@media (max-width: 520px) { .stills { grid-template-columns: 1fr; } }
)css";

std::string card(const std::string& title, const std::string& inside) {
  return "<div class=\"card\">" + (title.empty() ? "" : "<h3>" + escaped(title) + "</h3>\n") + inside + "</div>\n";
}

std::string head(const ReportInput& input) {
  std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n";
  text += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n";
  text += "<title>" + escaped(input.experiment) + "</title>\n<style>" + report::page_style + report::plot_style +
          own_style + "</style>\n</head>\n<body>\n<main>\n";
  return text + "<h1>" + escaped(input.experiment) + "</h1>\n<p class=\"under\">" + escaped(input.summary) +
         "; seed " + std::to_string(input.seed) + ", simulated clock</p>\n";
}

std::string cell(const std::string& words) { return "<td>" + (words.empty() ? "–" : escaped(words)) + "</td>"; }

/// Without columns that would be empty.
std::string figures_table(const ReportInput& input) {
  const std::vector<JudgedMetric> rows = judge(input.experiment, input.conditions, input.metrics);
  const bool compared = !paper_figures(input.experiment, input.conditions).empty();
  std::string text = "<div class=\"wide\"><table>\n<thead><tr><th>metric</th><th>Eciton</th>";
  if (compared) text += "<th>paper</th><th>bar</th><th></th>";
  text += "</tr></thead>\n<tbody>\n";
  for (const JudgedMetric& row : rows) {
    text += "<tr><td><code>" + escaped(row.metric) + "</code></td>" + cell(row.ours);
    if (compared) {
      const std::string verdict = to_text(row.verdict);
      text += cell(row.paper) + cell(row.bar) + "<td class=\"" + verdict + "\">" + verdict + "</td>";
    }
    text += "</tr>\n";
  }
  return card("", text +
                      "</tbody></table></div>\n<p class=\"note\">Metrics without a suffix are the physics' truth, "
                      "those that end in _estimated what the services believed.</p>\n");
}

std::string plot_cards(const ReportInput& input) {
  std::string text;
  for (const report::Plot& plot : input.plots) {
    const report::Drawing drawing = report::draw(plot);
    if (drawing.empty()) continue;
    text += card(plot.title, "<div class=\"wide\">" + drawing.svg + "</div>\n" +
                                 (plot.note.empty() ? "" : "<p class=\"note\">" + escaped(plot.note) + "</p>\n"));
  }
  return text.empty() ? "" : "<h2 id=\"plots\">Plots</h2>\n" + text;
}

std::string stills_of(const Pictures& pictures) {
  std::string text;
  if (!pictures.notice.empty()) text += "<p class=\"partial\">" + escaped(pictures.notice) + "</p>\n";
  if (!pictures.pictures.empty()) text += "<div class=\"stills\">\n";
  for (const Picture& picture : pictures.pictures) {
    char time[32];
    std::snprintf(time, sizeof time, "%.2f s", picture.time_s);
    const std::string title = escaped(picture.title);
    text += "<figure><img alt=\"" + title + "\" src=\"data:image/png;base64," + report::base64(picture.png) +
            "\"/><figcaption>" + title + " <span>" + time + "</span></figcaption></figure>\n";
  }
  if (!pictures.pictures.empty()) text += "</div>\n<p class=\"note\">" + escaped(pictures.colours) + "</p>\n";
  return text.empty() ? "" : "<h2 id=\"stills\">Stills</h2>\n" + text;
}

std::string what_was_run(const ReportInput& input) {
  std::string text = "<dl>\n<dt>command</dt><dd><code>" + escaped(input.command_line) +
                     "</code></dd>\n<dt>seed</dt><dd>" + std::to_string(input.seed) + "</dd>\n";
  for (const auto& [name, value] : input.config) {
    text += "<dt>" + escaped(name) + "</dt><dd>" + (value.empty() ? "–" : escaped(value)) + "</dd>\n";
  }
  return "<h2 id=\"run\">What was run</h2>\n" + card("", text + "</dl>\n");
}

}  // namespace

std::string report_page(const ReportInput& input) {
  return head(input) + "<h2 id=\"figures\">Figures</h2>\n" + figures_table(input) + plot_cards(input) +
         stills_of(input.pictures) + what_was_run(input) + "</main>\n</body>\n</html>\n";
}

}  // namespace eciton::deploy
