// Fig. S3: errors and convergence with the number of modules.
#include <cmath>
#include <map>

#include "deploy/experiments/report/plots.hpp"
#include "deploy/experiments/report/series.hpp"

namespace eciton::deploy {
namespace {

using report::Distributions;
using report::Lines;
using report::Plot;
using report::Trace;

constexpr double convergence_limit_s = 60;

std::vector<Trace> by_law(const Figures& figures, const std::string& series) {
  std::vector<Trace> traces;
  for (const char* law : {"local", "paper"}) {
    traces.push_back({.name = std::string(law) == "local" ? "the local law" : "the paper's law",
                      .x = series_of(figures, "modules"),
                      .y = series_of(figures, series + "_" + law),
                      .style = report::TraceStyle::points});
  }
  return traces;
}

Plot over_modules(const Figures& figures, const std::string& series, const std::string& title,
                  const std::string& label) {
  return {
      series, title, "",
      Lines{.x_label = "modules in the chain", .y_label = label, .traces = by_law(figures, series), .x_whole = true}};
}

/// A box and a violin for each number of modules.
Plot spread(const Figures& figures, const std::string& series, const std::string& title, const std::string& label) {
  const auto& modules = series_of(figures, "error_modules");
  const auto& values = series_of(figures, series);
  std::map<long, std::vector<double>> by_count;
  for (std::size_t i = 0; i < std::min(modules.size(), values.size()); ++i) {
    by_count[std::lround(modules[i])].push_back(values[i]);
  }
  Distributions out{.x_label = "modules in the chain", .y_label = label, .columns = {}};
  for (const auto& [count, here] : by_count) out.columns.push_back({std::to_string(count), here});
  return {series, title, "Box: quartiles; diamond and number below: mean; violin: density of the samples.",
          std::move(out)};
}

}  // namespace

std::vector<Plot> scaling_plots(const Figures& figures) {
  Plot convergence = over_modules(
      figures, "convergence_s", "Convergence time of the contact-wrench control (Fig. S3 B)", "convergence time, s");
  convergence.note = "Open markers: not converged within 60 s. The paper reports exponential growth.";
  auto& lines = std::get<Lines>(convergence.what);
  lines.y_logarithmic = true;
  for (Trace& trace : lines.traces) trace.cut_off = convergence_limit_s;
  return {over_modules(figures, "position_error_m", "Mean position error with the number of modules (Fig. S3 A)",
                       "position error, m"),
          over_modules(figures, "attitude_error_rad", "Mean attitude error with the number of modules (Fig. S3 A)",
                       "attitude error, rad"),
          spread(figures, "error_position_m", "Spread of the position error (Fig. S3 A)", "position error, m"),
          spread(figures, "error_attitude_rad", "Spread of the attitude error (Fig. S3 A)", "attitude error, rad"),
          std::move(convergence)};
}

}  // namespace eciton::deploy
