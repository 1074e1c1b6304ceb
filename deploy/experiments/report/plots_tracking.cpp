// Fig. S1: the path coloured by speed, and the norms of the errors.
#include "deploy/experiments/report/plots.hpp"
#include "deploy/experiments/report/series.hpp"

namespace eciton::deploy {

std::vector<report::Plot> tracking_plots(const Figures& figures) {
  const auto& time_s = series_of(figures, "time_s");
  const auto error = [&](const char* name, const char* title, const char* label, report::Level paper) {
    return report::Plot{name, title, "Line: low-passed at 5 Hz; band: the standard deviation over the whole flight.",
                        report::Lines{.x_label = "time, s",
                                      .y_label = label,
                                      .traces = {filtered("", time_s, series_of(figures, std::string(name)))},
                                      .marks = marks_of(figures),
                                      .levels = {std::move(paper)}}};
  };
  return {
      {"path", "Target and actual trajectory, coloured by speed (Fig. S1 B)", "",
       report::Path{series_of(figures, "x_m"), series_of(figures, "y_m"), series_of(figures, "z_m"),
                    series_of(figures, "speed_m_s"), series_of(figures, "x_reference_m"),
                    series_of(figures, "y_reference_m"), series_of(figures, "z_reference_m")}},
      error("position_error_m", "Position error (Fig. S1 C)", "position error, m", {0.15, "paper's mean 0.15"}),
      error("attitude_error_rad", "Attitude error (Fig. S1 D)", "attitude error, rad", {0.31, "paper's mean 0.31"})};
}

}  // namespace eciton::deploy
