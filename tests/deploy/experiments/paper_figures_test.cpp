// Figures are judged by the bars of their conditions.
#include "deploy/experiments/paper_figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace eciton::deploy {
namespace {

JudgedMetric row_of(const std::vector<JudgedMetric>& rows, const std::string& metric) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const JudgedMetric& row) { return row.metric == metric; });
  return found == rows.end() ? JudgedMetric{"not there", "", "", ""} : *found;
}

TEST(PaperFiguresTest, ABarIsMetUpToItsValue) {
  const auto verdict = [](double value) {
    return row_of(judge("docking", {}, {{"time_s_mean", value}}), "time_s_mean").verdict;
  };
  EXPECT_EQ(verdict(5), Verdict::met);
  EXPECT_EQ(verdict(5.01), Verdict::missed);
  EXPECT_EQ(verdict(NAN), Verdict::missed);
}

TEST(PaperFiguresTest, ConditionsChooseTheBar) {
  const auto bar = [](const RunConditions& run) {
    return row_of(judge("docking", run, {{"time_s_mean", 5.5}}), "time_s_mean");
  };
  EXPECT_EQ(bar({.gust_N = 1}).bar, "≤ 5");
  EXPECT_EQ(bar({.gust_N = 2}).bar, "≤ 6");
  EXPECT_EQ(bar({.gust_N = 2}).verdict, Verdict::met);
  EXPECT_EQ(bar({.sensing = "lio"}).paper, "12.9 s (LIO)");
  EXPECT_EQ(bar({.sensing = "mocap"}).paper, "16.0 s (mocap)");
  EXPECT_EQ(row_of(judge("morph", {.wakes = false}, {{"contact_force_N_mean", 0.2}}), "contact_force_N_mean").verdict,
            Verdict::missed);
  EXPECT_EQ(row_of(judge("morph", {.wakes = true}, {{"contact_force_N_mean", 0.2}}), "contact_force_N_mean").verdict,
            Verdict::met);
}

TEST(PaperFiguresTest, ABarMayBeOfAnotherMetric) {
  const auto verdict = [](double successes) {
    return row_of(judge("docking", {}, {{"successes", successes}, {"trials", 200}}), "successes").verdict;
  };
  EXPECT_EQ(verdict(198), Verdict::met);
  EXPECT_EQ(verdict(197), Verdict::missed);
  const JudgedMetric alone = row_of(judge("docking", {}, {{"successes", 198}}), "successes");
  EXPECT_EQ(alone.verdict, Verdict::none);  // of how many is not known
  EXPECT_EQ(alone.bar, "≥ 0.99 × trials");
}

TEST(PaperFiguresTest, WhatNobodySpeaksOfIsShownAfterThat) {
  const auto rows = judge("docking", {}, {{"a_metric", 1.5}, {"time_s_max", 7}, {"time_s_mean", 4}});
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].metric, "time_s_mean");
  EXPECT_EQ(rows[2].metric, "a_metric");
  EXPECT_EQ(rows[2].ours, "1.50");
  EXPECT_EQ(rows[2].verdict, Verdict::none);
  EXPECT_EQ(judge("hover", {}, {{"landed", 1}}).size(), 1u);
}

}  // namespace
}  // namespace eciton::deploy
