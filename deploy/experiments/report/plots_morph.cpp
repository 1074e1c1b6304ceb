// Fig. 4 B to E: contact wrenches, the base's errors, the joints, over time with T1, T2, ….
#include "deploy/experiments/report/plots.hpp"
#include "deploy/experiments/report/series.hpp"

namespace eciton::deploy {
namespace {

using report::Lines;
using report::Plot;
using report::Trace;

constexpr std::size_t links_max = 15, joints_max = 32;
constexpr const char* filter_note =
    "Lines: low-passed at 5 Hz; bands: the standard deviation over the entire interval.";

Plot over_time(const Figures& figures, const std::string& name, const std::string& title, const std::string& label,
               std::vector<Trace> traces, std::vector<report::Level> levels = {}) {
  return {name, title, filter_note,
          Lines{.x_label = "time, s",
                .y_label = label,
                .traces = std::move(traces),
                .marks = marks_of(figures),
                .levels = std::move(levels)}};
}

/// The truth of each link, and in its colour the estimate.
std::vector<Trace> links(const Figures& figures, const std::string& series) {
  const auto& time_s = series_of(figures, "time_s");
  std::vector<Trace> traces;
  for (std::size_t link = 1; link <= links_max; ++link) {
    const std::string number = std::to_string(link);
    Trace truth = filtered("link " + number, time_s, series_of(figures, series + "_" + number));
    Trace estimate = filtered_thin("link " + number + ", estimated", time_s,
                                   series_of(figures, series + "_" + number + "_estimated"));
    estimate.style = report::TraceStyle::dashed;
    truth.colour = estimate.colour = static_cast<int>(link - 1);
    traces.push_back(std::move(truth));
    traces.push_back(std::move(estimate));
  }
  return traces;
}

/// Numbered series as they are: a target has nothing to filter.
std::vector<Trace> numbered(const Figures& figures, const std::string& series, const std::string& name, bool filter) {
  const auto& time_s = series_of(figures, "time_s");
  std::vector<Trace> traces;
  for (std::size_t k = 1; k <= joints_max; ++k) {
    const auto& values = series_of(figures, series + "_" + std::to_string(k));
    if (values.empty()) continue;
    const std::string full = name + " " + std::to_string(k);
    Trace trace = filter ? filtered_thin(full, time_s, values) : Trace{.name = full, .x = time_s, .y = values};
    trace.style = traces.size() >= 8 ? report::TraceStyle::dashed : report::TraceStyle::solid;
    traces.push_back(std::move(trace));
  }
  return traces;
}

}  // namespace

std::vector<Plot> morph_plots(const Figures& figures) {
  const auto& time_s = series_of(figures, "time_s");
  const auto base = [&](const char* series) { return filtered("", time_s, series_of(figures, series)); };
  Plot targets = over_time(figures, "joint_rad", "Joint angles (Fig. 4 E)", "joint angle, rad",
                           numbered(figures, "joint_rad", "joint", false));
  targets.note.clear();
  return {over_time(figures, "contact_force_N", "Contact forces between modules (Fig. 4 B, C)", "contact force, N",
                    links(figures, "contact_force_N"), {{0.3, "paper's mean 0.3"}}),
          over_time(figures, "contact_torque_Nm", "Contact torques between modules (Fig. 4 B, C)",
                    "contact torque, Nm", links(figures, "contact_torque_Nm"), {{0.05, "paper's mean 0.05"}}),
          over_time(figures, "base_position_error_m", "Position error of the base module (Fig. 4 D)",
                    "position error, m", {base("base_position_error_m")}, {{0.06, "paper's mean 0.06"}}),
          over_time(figures, "base_attitude_error_rad", "Attitude error of the base module (Fig. 4 D)",
                    "attitude error, rad", {base("base_attitude_error_rad")}, {{0.02, "paper's mean 0.02"}}),
          std::move(targets),
          over_time(figures, "joint_torque_Nm", "Loads of the joint servos", "joint torque, Nm",
                    numbered(figures, "joint_torque_Nm", "joint", true), {{0.3, "paper's limit 0.3"}})};
}

}  // namespace eciton::deploy
