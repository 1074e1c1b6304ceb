// The table. Bars hold for any seed; what they depend on is said in words beside them.
#include "deploy/experiments/paper_figures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "deploy/report/text.hpp"

namespace eciton::deploy {
namespace {

using report::figure_text;

using Rows = std::vector<PaperFigure>;

Rows tracking(const RunConditions& run) {
  const bool lio = run.sensing == "lio";
  return {{.metric = "position_error_m_mean", .paper = "0.15 m", .most = lio ? 0.05 : 0.02},
          {.metric = "attitude_error_rad_mean", .paper = "0.31 rad", .most = lio ? 0.03 : 0.02},
          {.metric = "speed_m_s_max", .paper = "0.8 m/s"},
          {.metric = "laps", .paper = "3"}};
}

Rows docking(const RunConditions& run) {
  return {{.metric = "successes", .paper = "20 of 20", .least = 0.99, .of = "trials"},
          {.metric = "time_s_mean",
           .paper = run.sensing == "lio" ? "12.9 s (LIO)" : "16.0 s (mocap)",
           .most = run.gust_N > 1 ? 6 : 5},
          {.metric = "time_s_max", .most = 15},
          {.metric = "declared_by_wrench", .paper = "2 of 20 (LIO)"},
          {.metric = "false_declarations", .most = 0}};
}

Rows morph(const RunConditions& run) {
  return {{.metric = "contact_force_N_mean", .paper = "< 0.3 N", .most = run.wakes ? 0.3 : 0.12},
          {.metric = "contact_torque_Nm_mean", .paper = "about 0.05 Nm", .most = run.wakes ? 0.05 : 0.03},
          {.metric = "joint_torque_Nm_mean", .most = 0.10},
          {.metric = "joint_torque_Nm_max", .paper = "≤ 0.3 Nm", .most = 0.30},
          {.metric = "joint_speed_rad_s_max", .paper = "≤ 0.12 rad/s"},
          {.metric = "base_position_error_m_mean", .paper = "0.06 m", .most = 0.015},
          {.metric = "base_attitude_error_rad_mean", .paper = "0.02 rad", .most = 0.02},
          {.metric = "assembled", .paper = "yes", .least = 1},
          {.metric = "separated", .paper = "yes", .least = 1}};
}

Rows ablation(const RunConditions&) {
  return {
      {.metric = "contact_force_N_mean_none", .paper = "grows", .least = 3, .of = "contact_force_N_mean_local"},
      {.metric = "contact_torque_Nm_mean_none", .paper = "grows", .least = 5, .of = "contact_torque_Nm_mean_local"},
      {.metric = "contact_force_N_mean_local", .most = 1, .of = "contact_force_N_mean_paper"},
      {.metric = "contact_force_N_mean_paper", .paper = "about zero"},
      {.metric = "contact_torque_Nm_mean_paper", .paper = "about zero"}};
}

Rows scaling(const RunConditions&) {
  Rows rows{
      {.metric = "position_error_m_mean_8", .paper = "constant with N", .most = 1.2, .of = "position_error_m_mean_1"},
      {.metric = "attitude_error_rad_mean_8",
       .paper = "constant with N",
       .most = 1.2,
       .of = "attitude_error_rad_mean_1"}};
  for (int modules = 2; modules <= 8; ++modules) {
    rows.push_back({.metric = "convergence_s_" + std::to_string(modules),
                    .paper = "exponential with N",
                    .most = modules == 2 ? 1 : 3});
  }
  return rows;
}

Rows wind(const RunConditions&) {
  return {{.metric = "contact_force_N_shift", .paper = "says it is compensated", .most = 0.1},
          {.metric = "contact_torque_Nm_shift", .paper = "says it is compensated", .most = 0.05}};
}

Rows release(const RunConditions&) {
  return {{.metric = "displacement_m_max", .paper = "names instability here", .most = 0.15},
          {.metric = "contact_force_N_peak"},
          {.metric = "joint_torque_Nm_peak"}};
}

Rows silence(const RunConditions&) {
  return {{.metric = "base_position_error_m_max", .most = 0.05},
          {.metric = "contact_force_N_max", .most = 3},
          {.metric = "recovered_s", .most = 2}};
}

Rows crossing(const RunConditions&) {
  return {{.metric = "distance_m_min", .least = 1.0}, {.metric = "arrived", .least = 4}};
}

Rows forest(const RunConditions&) {
  return {{.metric = "docking_s", .paper = "12.2 s", .most = 12},
          {.metric = "position_error_m_mean", .paper = "0.09 m", .most = 0.06},
          {.metric = "attitude_error_rad_mean", .paper = "0.06 rad", .most = 0.03}};
}

std::string bar_text(const PaperFigure& figure) {
  const std::string of = figure.of.empty() ? "" : " × " + figure.of;
  const auto side = [&](const char* sign, double bar) {
    return std::string(sign) + " " + (bar == 1 && !of.empty() ? figure.of : figure_text(bar) + of);
  };
  std::string text;
  if (figure.least) text = side("≥", *figure.least);
  if (figure.most) text += (text.empty() ? "" : ", ") + side("≤", *figure.most);
  return text;
}

Verdict verdict_of(const PaperFigure& figure, double value, const std::map<std::string, double>& metrics) {
  if (!figure.least && !figure.most) return Verdict::none;
  double scale = 1;
  if (!figure.of.empty()) {
    const auto other = metrics.find(figure.of);
    if (other == metrics.end()) return Verdict::none;
    scale = other->second;
  }
  // What is no number meets nothing.
  const bool enough = !figure.least || value >= *figure.least * scale;
  const bool little = !figure.most || value <= *figure.most * scale;
  return enough && little ? Verdict::met : Verdict::missed;
}

}  // namespace

std::vector<PaperFigure> paper_figures(const std::string& experiment, const RunConditions& conditions) {
  static const std::map<std::string, Rows (*)(const RunConditions&)> table{
      {"tracking", &tracking}, {"docking", &docking}, {"morph", &morph},     {"ablation", &ablation},
      {"scaling", &scaling},   {"wind", &wind},       {"release", &release}, {"silence", &silence},
      {"crossing", &crossing}, {"forest", &forest}};
  const auto rows = table.find(experiment);
  return rows == table.end() ? Rows{} : rows->second(conditions);
}

std::vector<JudgedMetric> judge(const std::string& experiment, const RunConditions& conditions,
                                const std::map<std::string, double>& metrics) {
  std::vector<JudgedMetric> judged;
  for (const PaperFigure& figure : paper_figures(experiment, conditions)) {
    const auto found = metrics.find(figure.metric);
    if (found == metrics.end()) continue;
    judged.push_back({.metric = figure.metric,
                      .ours = figure_text(found->second),
                      .paper = figure.paper,
                      .bar = bar_text(figure),
                      .verdict = verdict_of(figure, found->second, metrics)});
  }
  const std::size_t spoken_of = judged.size();
  for (const auto& [metric, value] : metrics) {
    const auto end = judged.begin() + static_cast<std::ptrdiff_t>(spoken_of);
    if (std::none_of(judged.begin(), end,
                     [&, name = metric](const JudgedMetric& row) { return row.metric == name; })) {
      judged.push_back({.metric = metric, .ours = figure_text(value), .paper = "", .bar = ""});
    }
  }
  return judged;
}

std::string to_text(Verdict verdict) {
  return verdict == Verdict::met ? "met" : verdict == Verdict::missed ? "missed" : "";
}

}  // namespace eciton::deploy
