// Series by their names, "<quantity>_<unit>[_<qualifier>]", and the traces that are made of them.
#pragma once

#include <string>
#include <vector>

#include "deploy/experiments/experiment.hpp"

namespace eciton::deploy {

/// "contact_force_N_1_estimated": contact force, N, "1 estimated".
struct SeriesName {
  std::string quantity, unit, qualifier;
};
/// An empty unit: the name has none that is known.
SeriesName parse_series_name(const std::string& name);
/// "rad/s" of "rad_s".
std::string unit_text(const std::string& unit);

/// The series, or an empty one: a plot leaves out what was not recorded.
const std::vector<double>& series_of(const Figures& figures, const std::string& name);

/// As the paper draws: low-passed at 5 Hz, in a band of the standard deviation over the entire interval.
report::Trace filtered(const std::string& name, const std::vector<double>& time_s, const std::vector<double>& values);
/// Low-passed too, thin, without a band: an estimate beside its truth.
report::Trace filtered_thin(const std::string& name, const std::vector<double>& time_s,
                            const std::vector<double>& values);

/// Mean and standard deviation over trials at each time, from samples of all trials one after the other; times are
/// put together to 0.02 s. Times with fewer than half of the trials are left out.
report::Trace mean_of_trials(const std::string& name, const std::vector<double>& trial,
                             const std::vector<double>& time_s, const std::vector<double>& values);

/// T1, T2, … at mark_s.
std::vector<report::Mark> marks_of(const Figures& figures);

}  // namespace eciton::deploy
