// Fig. 5 B to E: how long the dockings took, how they closed in, how steady the assembled state is.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "deploy/experiments/report/plots.hpp"
#include "deploy/experiments/report/series.hpp"
#include "deploy/report/statistics.hpp"

namespace eciton::deploy {
namespace {

using report::Distributions;
using report::Lines;
using report::Plot;
using report::Range;

constexpr double approach_axial_m = 0.30, approach_tolerance_m = 0.025;
constexpr double assembly_axial_m = 0.0125, assembly_radial_m = 0.025;
constexpr double always = 1e9;
constexpr const char* mean_and_deviation =
    "Line: mean over the trials; band: their standard deviation. Time 0: latched.";

Plot times(const Figures& figures) {
  const auto& time_s = series_of(figures, "time_s");
  const auto& success = series_of(figures, "success");
  std::vector<double> docked;
  for (std::size_t i = 0; i < std::min(time_s.size(), success.size()); ++i) {
    if (success[i] > 0) docked.push_back(time_s[i]);
  }
  return {
      "docking_time", "Time from the accepted goal to docked (Fig. 5 B)",
      "Successful trials. Box: quartiles, whiskers within 1.5 times their distance; diamond: mean; violin: density.",
      Distributions{.x_label = "",
                    .y_label = "docking time, s",
                    .columns = {{"Eciton", docked}},
                    .levels = {{16.0, "paper, mocap 16.0"}, {12.9, "paper, LIO 12.9"}}}};
}

Plot against_time(const Figures& figures, const char* series, const char* title, const char* label,
                  std::vector<Range> ranges) {
  return {series, title, mean_and_deviation,
          Lines{.x_label = "time before the latch, s",
                .y_label = label,
                .traces = {mean_of_trials("", series_of(figures, "approach_trial"),
                                          series_of(figures, "approach_time_s"), series_of(figures, series))},
                .ranges = std::move(ranges)}};
}

/// The paper's picture: how far aside, over how far away.
Plot closing_in(const Figures& figures) {
  constexpr double step_m = 0.005;
  const auto& axial_m = series_of(figures, "approach_axial_m");
  const auto& radial_m = series_of(figures, "approach_radial_m");
  std::map<long, std::vector<double>> at;
  for (std::size_t i = 0; i < std::min(axial_m.size(), radial_m.size()); ++i) {
    if (std::isfinite(axial_m[i]) && axial_m[i] < 0.45) at[std::lround(axial_m[i] / step_m)].push_back(radial_m[i]);
  }
  report::Trace trace{.name = "mean over the trials", .x = {}, .y = {}};
  for (const auto& [step, here] : at) {
    if (here.size() < 5) continue;
    trace.x.push_back(static_cast<double>(step) * step_m);
    trace.y.push_back(report::mean(here));
    trace.band.push_back(report::standard_deviation(here));
  }
  return {"approach_plane", "Relative position of the two ports (Fig. 5 C)",
          "Line: mean of the samples at a distance; band: their standard deviation.",
          Lines{.x_label = "axial distance, m",
                .y_label = "radial distance, m",
                .traces = {std::move(trace)},
                .ranges = {{approach_axial_m - approach_tolerance_m, approach_axial_m + approach_tolerance_m, 0,
                            approach_tolerance_m, "tolerance for approach"},
                           {-assembly_axial_m, assembly_axial_m, 0, assembly_radial_m, "tolerance for assembly"}}}};
}

Plot assembled(const Figures& figures, const char* series, const char* title, const char* label,
               std::vector<report::Level> levels) {
  return {series, title, "Samples of all trials in the assembled state.",
          Distributions{.x_label = "",
                        .y_label = label,
                        .columns = {{"Eciton", series_of(figures, series)}},
                        .levels = std::move(levels)}};
}

}  // namespace

std::vector<Plot> docking_plots(const Figures& figures) {
  return {
      times(figures),
      closing_in(figures),
      against_time(figures, "approach_axial_m", "Axial distance before the latch (Fig. 5 C)", "axial distance, m",
                   {{-always, always, approach_axial_m - approach_tolerance_m,
                     approach_axial_m + approach_tolerance_m, "tolerance for approach"},
                    {-always, always, -assembly_axial_m, assembly_axial_m, "tolerance for assembly"}}),
      against_time(figures, "approach_radial_m", "Radial distance before the latch (Fig. 5 C)", "radial distance, m",
                   {{-always, always, 0, approach_tolerance_m, "tolerance for approach and assembly"}}),
      against_time(figures, "approach_attitude_rad", "Attitude error before the latch (Fig. 5 C)",
                   "attitude error, rad", {}),
      assembled(figures, "assembled_position_error_m", "Position error, assembled (Fig. 5 D)", "position error, m",
                {{0.02, "paper, mocap 0.02"}, {0.04, "paper, LIO 0.04"}}),
      assembled(figures, "assembled_contact_force_N_estimated", "Estimated contact force, assembled (Fig. 5 E)",
                "contact force, N", {}),
      assembled(figures, "assembled_contact_torque_Nm_estimated", "Estimated contact torque, assembled (Fig. 5 E)",
                "contact torque, Nm", {}),
  };
}

}  // namespace eciton::deploy
