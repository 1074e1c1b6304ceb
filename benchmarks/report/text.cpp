// For people: numbers of a readable length, tables aligned by their columns.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "benchmarks/report/result.hpp"
#include "benchmarks/statistics/summary.hpp"

namespace eciton::bench {
namespace {

/// Code points: "µ", "≤" and "–" take one column.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string to_text(const Table& table) {
  std::string text = table.title.empty() ? "" : table.title + "\n";
  std::vector<std::size_t> widths;
  for (const std::string& column : table.columns) widths.push_back(width(column));
  for (const std::vector<std::string>& row : table.rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  const auto add_row = [&](const std::vector<std::string>& row) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string space(widths[i] - width(row[i]), ' ');
      line += " " + (i == 0 ? row[i] + space : " " + space + row[i]);  // names to the left, figures to the right
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  };
  add_row(table.columns);
  for (const std::vector<std::string>& row : table.rows) add_row(row);
  return text;
}

std::string interval_text(const Interval& interval) {
  if (std::isnan(interval.value)) return "–";
  return number_text(interval.value) + " [" + number_text(interval.low) + ", " + number_text(interval.high) + "]";
}

Table summary_table(const std::string& title, const std::vector<Samples>& samples) {
  Table table{title,
              {"", "unit", "count", "mean", "p50", "p90", "p99", "p99.9", "p99.99", "max", "jitter mean",
               "jitter p99", "lost", "dup."},
              {}};
  for (const Samples& one : samples) {
    const Summary s = summarize(one);
    const auto at = [&](double fraction, double value) {
      return resolves(s.count, fraction) ? number_text(value) : std::string("–");
    };
    const bool sent = one.sent > 0;
    table.rows.push_back({one.name + (one.partial ? " (partial)" : ""), one.unit, grouped(std::to_string(s.count)),
                          number_text(s.mean), number_text(s.p50), at(0.9, s.p90), at(0.99, s.p99), at(0.999, s.p999),
                          at(0.9999, s.p9999), number_text(s.max), number_text(s.jitter_mean),
                          s.count > 1 && resolves(s.count - 1, 0.99) ? number_text(s.jitter_p99) : "–",
                          sent ? grouped(std::to_string(one.lost)) : "–",
                          sent ? grouped(std::to_string(one.duplicates)) : "–"});
  }
  return table;
}

std::string to_text(const Result& result) {
  std::string text = result.title + (result.partial ? " (partial)" : "") + ", " + result.clock + " clock";
  if (!result.seed.is_null()) text += ", seed " + result.seed.dump();
  text += "\n";
  for (const Table& table : result.tables) text += "\n" + to_text(table);
  if (!result.notes.empty()) text += "\n";
  for (const std::string& note : result.notes) text += "  " + note + "\n";
  return text;
}

}  // namespace eciton::bench
