// What a measuring verb found, and the four ways it is told: a table for people, a JSON object for programs,
// raw samples as CSV, and one page that needs nothing but a browser.
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/statistics/bootstrap.hpp"
#include "benchmarks/statistics/samples.hpp"
#include "core/base/result.hpp"
#include "deploy/command/message_json.hpp"
#include "deploy/report/text.hpp"

namespace eciton::bench {

using Json = deploy::Json;
using report::escaped;
using report::grouped;
using report::number_text;

/// The first column names the row; cells are text, ready to be read.
struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows = {};
};

/// Side by side within its group.
struct Bar {
  std::string group;  // "256 B"
  std::string name;   // "Cyclone DDS, ours": one colour on the whole chart; names of one group only: its colour
  Interval value;     // whiskers where low and high are finite
};

struct Bars {
  std::string title, unit;
  std::vector<Bar> bars = {};
  std::optional<double> limit = {};  // drawn as a line
};

struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points = {};
};

/// How something grows: both axes logarithmic where the values span more than a factor of 20.
struct Curves {
  std::string title, x_name, unit;
  std::vector<Curve> curves = {};
};

struct Result {
  std::string title;    // "Latency"
  std::string command;  // "bench latency"
  std::string clock;    // monotonic, wall or simulated
  Json config = Json::object();
  Json seed = nullptr;
  Json metrics = Json::object();  // flat name: number
  std::vector<Samples> samples;
  std::vector<Table> tables;
  std::vector<Bars> bars;
  std::vector<Curves> curves;
  std::vector<std::string> notes;  // clock-error bounds, missing peers, how late the sender was
  bool partial = false;            // interrupted, or something to be measured was not there
};

/// Count, mean, quantiles, max, jitter, loss and duplicates of each; a quantile that is not resolved is "–".
Table summary_table(const std::string& title, const std::vector<Samples>& samples);

/// "1.02 [0.99, 1.06]"
std::string interval_text(const Interval& interval);

std::string to_text(const Table& table);
/// Tables and notes, for people.
std::string to_text(const Result& result);
/// One self-contained page.
std::string to_html(const Result& result);
/// name,unit,at_s,value: every raw sample in a line of its own.
void write_csv(std::ostream& file, const Result& result);

struct ReportFiles {
  std::string json, csv, html;  // empty: not asked for
};

/// Before the work that is to be measured: whether its result can be kept.
Status check_report_files(const ReportFiles& files);
/// The Error names the option, the file and why it cannot be written; the other files are written all the same.
Status write_report_files(const ReportFiles& files, const Result& result);

/// One line on the terminal, overwritten; silent when standard error is not a terminal.
class ProgressLine {
 public:
  explicit ProgressLine(std::string command);
  ~ProgressLine();  // clears it
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// "bench latency: 3 of 24, 41 s left: ours on cyclonedds, 256 B"
  void show(std::size_t finished, std::size_t all, double left_s, const std::string& doing);

 private:
  std::string command_;
  bool live_;
};

}  // namespace eciton::bench
