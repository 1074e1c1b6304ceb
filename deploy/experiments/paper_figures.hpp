// What the papers report of an experiment, and the bar that ours must meet, metric by metric.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace eciton::deploy {

/// What decides which of the paper's figures and which bar hold.
struct RunConditions {
  std::string sensing = "mocap";
  std::string law = "local";
  bool wakes = true;
  double gust_N = 0;
};

struct PaperFigure {
  std::string metric;
  std::string paper = {};            // "16.0 s (mocap)"; empty: the paper says nothing
  std::optional<double> least = {};  // the bar: least <= value ...
  std::optional<double> most = {};   // ... <= most, both times the value of metric `of`, if one is named
  std::string of = {};
};

/// In the order in which they are shown. Empty: an experiment that no paper has, without a bar.
std::vector<PaperFigure> paper_figures(const std::string& experiment, const RunConditions& conditions);

enum class Verdict { none, met, missed };

struct JudgedMetric {
  std::string metric;
  std::string ours, paper, bar;  // for people; empty: nothing
  Verdict verdict = Verdict::none;
};

/// Those that the paper or a bar speaks of first, then all others.
std::vector<JudgedMetric> judge(const std::string& experiment, const RunConditions& conditions,
                                const std::map<std::string, double>& metrics);

std::string to_text(Verdict verdict);  // "met", "missed", ""

}  // namespace eciton::deploy
