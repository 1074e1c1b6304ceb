// Figures judged on made-up results: reached, missed, and not measured at all, which is missed too.
#include "benchmarks/gate/figures.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace eciton::bench {
namespace {

void add_run(Json& results, const std::string& name, double cpu_time_ns) {
  results["benchmarks"].push_back({{"name", name + "/repeats"},
                                   {"run_name", name},
                                   {"run_type", "iteration"},
                                   {"cpu_time", cpu_time_ns},
                                   {"real_time", 1e9},
                                   {"time_unit", "ns"}});
}

Json figures() { return Json::parse(std::ifstream(ECITON_GATE_FIGURES)); }

/// As a run gives them in which everything is reached.
Json good_results() {
  Json results;
  add_run(results, "contact_wrench/dense_qr/32", 640'000);
  add_run(results, "contact_wrench/band_cholesky/32", 11'000);
  add_run(results, "contact_wrench/block_cholesky/32", 10'000);
  add_run(results, "contact_wrench/sparse_cholesky/32", 18'000);
  add_run(results, "contact_wrench/sparse_qr/32", 47'000);
  add_run(results, "contact_wrench/recursion/32", 900);  // disturbed
  add_run(results, "contact_wrench/recursion/32", 350);
  add_run(results, "contact_wrench/recursion/1024", 10'500);
  results["benchmarks"].push_back(
      {{"run_name", "contact_wrench/recursion/32"}, {"run_type", "aggregate"}, {"cpu_time", 1}, {"time_unit", "ns"}});
  return results;
}

TEST(RatiosTest, TakesTheQuickestRepetitionAndTheBestRival) {
  const auto verdict = judge_ratios(good_results(), figures()["ratios"]);
  ASSERT_TRUE(verdict) << verdict.error().message;
  EXPECT_TRUE(verdict->missed.empty());
  ASSERT_EQ(verdict->table.rows.size(), 3u);
  EXPECT_EQ(verdict->table.rows[0][2], number_text(640'000. / 350));
  EXPECT_EQ(verdict->table.rows[1][2], number_text(10'000. / 350));
  EXPECT_EQ(verdict->table.rows[2][2], number_text(30));
}

TEST(RatiosTest, ARecursionThatIsNotLinearIsMissed) {
  Json results = good_results();
  for (Json& run : results["benchmarks"]) {
    if (run["run_name"] == "contact_wrench/recursion/1024") run["cpu_time"] = 350 * 1024;  // quadratic
  }
  const auto verdict = judge_ratios(results, figures()["ratios"]);
  ASSERT_TRUE(verdict);
  ASSERT_EQ(verdict->missed.size(), 1u);
  EXPECT_NE(verdict->missed[0].find("1,024, where ≤ 40.0 is right"), std::string::npos) << verdict->missed[0];
}

TEST(RatiosTest, WhatDidNotRunIsMissed) {
  Json results = good_results();
  results["benchmarks"].erase(2);  // the best rival
  EXPECT_EQ(judge_ratios(results, figures()["ratios"])->missed.size(), 1u);
  EXPECT_EQ(judge_ratios({{"benchmarks", Json::array()}}, figures()["ratios"])->missed.size(), 3u);
}

TEST(RatiosTest, AnythingElseIsNotJudged) {
  const auto verdict = judge_ratios(Json::object(), figures()["ratios"]);
  ASSERT_FALSE(verdict);
  EXPECT_NE(verdict.error().message.find("benchmarks"), std::string::npos);
}

Json latency(double cyclone, double fast) {
  return {{"command", "bench latency"},
          {"series", {{"partial", false}}},
          {"metrics",
           {{"tax_p50_high.cyclonedds.wake.256", cyclone},
            {"tax_p50_high.fastdds.wake.256", fast},
            {"tax_p99.fastdds.wake.256", 9.0},
            {"over_udp_p50.cyclonedds.inline.256", 2.1},
            {"over_udp_p50.cyclonedds.wake.256", 3.2}}}};
}
Json latency_figures() { return figures()["metrics"]["bench latency"]; }

TEST(MetricsTest, EveryMetricOfThePatternIsJudged) {
  EXPECT_TRUE(judge_metrics(latency(1.02, 1.04), latency_figures())->missed.empty());
  const auto verdict = judge_metrics(latency(1.02, 1.08), latency_figures());
  ASSERT_EQ(verdict->missed.size(), 1u);
  EXPECT_EQ(verdict->missed[0], "tax_p50_high.fastdds.wake.256: 1.08, where ≤ 1.05 is right");
}

TEST(MetricsTest, NoMetricNoValueAndARunCutShortAreMissed) {
  Json measurement = latency(1.02, 1.04);
  measurement["metrics"]["tax_p50_high.fastdds.wake.256"] = nullptr;
  EXPECT_EQ(judge_metrics(measurement, latency_figures())->missed.size(), 1u);
  measurement["metrics"] = Json::object();
  EXPECT_EQ(judge_metrics(measurement, latency_figures())->missed.size(), latency_figures().size());
  measurement = latency(1.02, 1.04);
  measurement["series"]["partial"] = true;
  EXPECT_EQ(judge_metrics(measurement, latency_figures())->missed.size(), 1u);
}

}  // namespace
}  // namespace eciton::bench
