// The report of one run: a page that needs nothing but a browser, and beside it each plot and still as a file.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "deploy/experiments/experiment.hpp"
#include "deploy/experiments/paper_figures.hpp"
#include "deploy/experiments/report/stills.hpp"

namespace eciton::deploy {

struct ReportInput {
  std::string experiment, summary;
  std::string command_line;  // that makes the same figures again
  std::uint64_t seed = 0;
  RunConditions conditions;
  std::vector<std::pair<std::string, std::string>> config;  // what decided the figures, by name
  std::map<std::string, double> metrics;
  std::vector<report::Plot> plots;
  Pictures pictures;
};

/// Well-formed XML, and without a reference to anything outside.
std::string report_page(const ReportInput& input);

/// Makes the directory and sees whether it takes files: before the work that is to be shown.
Status check_report_directory(const std::string& directory);

/// Ours beside the paper's figures and the bars, as a table in Markdown: of the metrics that either speaks of.
std::string figures_markdown(const ReportInput& input);

/// Writes DIR/NAME.html, DIR/NAME/figures.md, DIR/NAME/<plot>.svg and DIR/NAME/still_<k>.png; the path of the page.
/// The Error names the file and why it cannot be written.
Result<std::string> write_report(const std::string& directory, const ReportInput& input);

}  // namespace eciton::deploy
