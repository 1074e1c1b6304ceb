// Names and traces of series, and which plots they make.
#include "deploy/experiments/report/series.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "deploy/experiments/report/plots.hpp"
#include "deploy/report/draw.hpp"

namespace eciton::deploy {
namespace {

TEST(SeriesNameTest, HasQuantityUnitAndQualifier) {
  const auto parsed = [](const std::string& name) {
    const SeriesName p = parse_series_name(name);
    return p.quantity + "|" + p.unit + "|" + p.qualifier;
  };
  EXPECT_EQ(parsed("contact_force_N_1_estimated"), "contact force|N|1 estimated");
  EXPECT_EQ(parsed("speed_m_s"), "speed|m_s|");
  EXPECT_EQ(parsed("x_reference_m"), "x reference|m|");
  EXPECT_EQ(parsed("joint_speed_rad_s_max"), "joint speed|rad_s|max");
  EXPECT_EQ(parsed("distance_m_min"), "distance|m|min");
  EXPECT_EQ(parsed("success"), "success||");
}

TEST(TraceTest, ABandIsTheDeviationOfTheValuesThemselves) {
  std::vector<double> time_s, values;
  for (int i = 0; i < 1000; ++i) {
    time_s.push_back(0.01 * i);
    values.push_back(i % 2 == 0 ? 1 : 3);  // 50 Hz: filtered away, but not from the band
  }
  const report::Trace trace = filtered("a", time_s, values);
  ASSERT_EQ(trace.band.size(), 1u);
  EXPECT_NEAR(trace.band[0], 1, 1e-9);
  EXPECT_NEAR(trace.y[900], 2, 0.05);
  values[500] = NAN;
  const report::Trace gap = filtered("a", time_s, values);
  EXPECT_TRUE(std::isnan(gap.y[500]));
  EXPECT_NEAR(gap.y[900], 2, 0.05);
}

TEST(TraceTest, TrialsAreAveragedAtEachTime) {
  const report::Trace trace = mean_of_trials("a", {0, 0, 1, 1, 1}, {-0.02, 0, -0.0199, 0.0001, -4}, {1, 2, 3, 6, 9});
  ASSERT_EQ(trace.x.size(), 3u);  // one of two trials at -4 s is half of them
  EXPECT_DOUBLE_EQ(trace.y[1], 2);
  EXPECT_DOUBLE_EQ(trace.y[2], 4);
  EXPECT_DOUBLE_EQ(trace.band[2], 2);
}

constexpr auto all_plots = {&tracking_plots, &docking_plots, &morph_plots,
                            &ablation_plots, &scaling_plots, &series_plots};

TEST(PlotsTest, AMissingSeriesLeavesItsPlotOut) {
  for (const auto plots : all_plots) {
    for (const report::Plot& plot : plots({})) EXPECT_TRUE(report::draw(plot).empty()) << plot.name;
  }
  Figures some;
  some.series["time_s"] = {0, 1, 2};  // and nothing else
  some.series["mark_s"] = {1};
  for (const auto plots : all_plots) {
    for (const report::Plot& plot : plots(some)) EXPECT_TRUE(report::draw(plot).empty()) << plot.name;
  }
}

TEST(PlotsTest, SeriesOfDifferentLengthsAreNoTrouble) {
  Figures odd;
  odd.series["time_s"] = {0, 1, 2};
  odd.series["success"] = {1, 1, 0, 1};
  for (const char* name : {"position_error_m", "contact_force_N_1", "contact_force_N_local", "joint_rad",
                           "convergence_s_local", "x_m", "y_m", "speed_m_s", "base_position_error_m"}) {
    odd.series[name] = {1, 2, 3, 4, 5};
  }
  odd.series["modules"] = {1};
  odd.series["error_modules"] = {1, 2};
  odd.series["error_position_m"] = {1};
  for (const auto plots : all_plots) {
    for (const report::Plot& plot : plots(odd)) EXPECT_NO_FATAL_FAILURE(report::draw(plot));
  }
}

TEST(PlotsTest, OnlySuccessfulDockingsHaveATime) {
  Figures figures;
  figures.series["success"] = {1, 0, 1};
  figures.series["time_s"] = {4, 45, 5};
  const report::Plot plot = docking_plots(figures).front();
  EXPECT_EQ(std::get<report::Distributions>(plot.what).columns[0].values, (std::vector<double>{4, 5}));
}

TEST(PlotsTest, OtherSeriesAreTogetherByWhatTheyMean) {
  Figures figures;
  for (const char* name :
       {"time_s", "x_m", "y_m", "distance_m_12", "distance_m_13", "contact_force_N_1", "speed_m_s"}) {
    figures.series[name] = {0, 1, 2};
  }
  figures.series["elsewhere_m"] = {1};  // of another length
  std::string names;
  for (const report::Plot& plot : series_plots(figures)) names += plot.name + " ";
  EXPECT_EQ(names, "contact_force_N distance_m position_m speed_m_s ");
}

}  // namespace
}  // namespace eciton::deploy
