// Fig. S2 B to D: the same morph without contact-wrench control, with the paper's law and with ours.
#include <array>
#include <cmath>

#include "deploy/experiments/report/plots.hpp"
#include "deploy/experiments/report/series.hpp"

namespace eciton::deploy {
namespace {

using report::Lines;
using report::Plot;
using report::Trace;

constexpr std::array<std::array<const char*, 2>, 3> laws{
    {{"none", "without control"}, {"paper", "the paper's law"}, {"local", "the local law"}}};

/// T0: when the joints begin to move.
std::vector<report::Mark> start_of(const Figures& figures) {
  const auto& given = series_of(figures, "mark_s");
  if (!given.empty()) return {{given.front(), "T0"}};
  const auto& time_s = series_of(figures, "time_s");
  const auto& target = series_of(figures, "joint_rad");
  for (std::size_t i = 0; i < std::min(time_s.size(), target.size()); ++i) {
    if (std::abs(target[i] - target.front()) > 1e-6) return {{time_s[i], "T0"}};
  }
  return {};
}

Plot by_law(const Figures& figures, const std::string& series, const std::string& title, const std::string& label) {
  std::vector<Trace> traces;
  for (std::size_t k = 0; k < laws.size(); ++k) {
    traces.push_back(
        filtered(laws[k][1], series_of(figures, "time_s"), series_of(figures, series + "_" + laws[k][0])));
    traces.back().colour = static_cast<int>(k == 0 ? 7 : k - 1);
  }
  return {series, title, "Lines: low-passed at 5 Hz; bands: the standard deviation over the entire interval.",
          Lines{.x_label = "time, s", .y_label = label, .traces = std::move(traces), .marks = start_of(figures)}};
}

}  // namespace

std::vector<Plot> ablation_plots(const Figures& figures) {
  Plot target{"joint_rad", "Joint angle (Fig. S2 B)", "",
              Lines{.x_label = "time, s",
                    .y_label = "joint angle, rad",
                    .traces = {{.name = "", .x = series_of(figures, "time_s"), .y = series_of(figures, "joint_rad")}},
                    .marks = start_of(figures)}};
  return {
      std::move(target),
      by_law(figures, "contact_force_N", "Contact force between the modules (Fig. S2 C)", "contact force, N"),
      by_law(figures, "contact_torque_Nm", "Contact torque between the modules (Fig. S2 D)", "contact torque, Nm")};
}

}  // namespace eciton::deploy
